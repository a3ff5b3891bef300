/// Whether the blocks of an effect make sense.
#pragma once
#include "tools/effects/effect.h"

namespace loopwright {

/// Reports what keeps the effect from a linear and from a rotary machine: blocks that do not exist, wrong
/// settings, units.
void check_blocks(const Effect& effect, Problems& problems);

}  // namespace loopwright
