/// The straight line through the steps of a quantiser.
#pragma once
#include "tools/linearize/block_bench.h"

namespace loopwright {

struct Staircase {
  double width = 0;           ///< of a step, in the unit of the input
  std::vector<double> slope;  ///< an element for each output; empty: no staircase
};

/// Outputs that are flat around where the block stands, but rise by equal steps at equal distances on both
/// sides when the mode is decided anew: three treads are looked at. The derivative of a staircase, 0, would
/// cut a loop that a quantiser only roughens. A switch, a relay or friction has no second step and is none.
Staircase find_staircase(BlockBench& bench, size_t input);

}  // namespace loopwright
