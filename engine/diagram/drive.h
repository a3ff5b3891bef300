/// Recorded columns in the place of what feeds an input port.
#pragma once
#include <vector>
#include "engine/diagram/diagram.h"

namespace loopwright {

/// Adds a block at the top for each drive and leads its output to the port, through new inputs of the
/// subdiagrams on the way. A port that does not exist in a nest of subdiagrams is a problem; ports of blocks
/// are checked by the plan.
void apply_drives(Diagram& top, const std::vector<Drive>& drives, Problems& problems);

}  // namespace loopwright
