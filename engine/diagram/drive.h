/// Replaces the sources of input ports by recorded columns.
#pragma once
#include <vector>
#include "engine/diagram/diagram.h"

namespace loopwright {

/// Adds a block at the top level for each drive and connects its output to the port, through new inputs of
/// the subdiagrams on the way. A port that does not exist within nested subdiagrams is a problem; ports of
/// blocks are checked by the plan.
void apply_drives(Diagram& top, const std::vector<Drive>& drives, Problems& problems);

}  // namespace loopwright
