/// The straight line through the steps of a quantizer.
#pragma once
#include "tools/linearize/block_bench.h"

namespace loopwright {

struct Staircase {
  double width = 0;           ///< of a step, in the unit of the input
  std::vector<double> slope;  ///< one element per output; empty: no staircase
};

/// Outputs that are constant around the operating point of the block, but rise by equal steps at equal
/// distances on both sides when the mode is determined anew: three treads are examined. The derivative of a
/// staircase, 0, would cut a loop in which a quantizer only adds roughness. A switch, a relay or friction has
/// no second step and is no staircase.
Staircase find_staircase(BlockBench& bench, size_t input);

}  // namespace loopwright
