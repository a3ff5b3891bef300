/// One block of a run as a linear system at its operating point.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>
#include "engine/run/run.h"

namespace loopwright {

/// A note about a block for the reader of linear results: what was held, linearized or left out.
struct LinearizationNote {
  enum class Kind {
    held,       ///< its mode is held: sticking friction keeps sticking, a switch does not switch
    flat,       ///< an output does not depend on an input here: saturated, switched away, at rest
    staircase,  ///< a quantizer, replaced by the straight line through its steps
    corner,     ///< two one-sided slopes differ; their mean is taken
    inaccurate  ///< a slope could not be determined, or not to six digits
  };
  Kind kind;
  std::string block;  ///< path
  std::string text;   ///< a sentence
  double size = 0;    ///< of a staircase: height of a step, in the unit of the output
};

/// Rows of C and D are the numbers that the block computes, except outputs bound to states; columns of B and
/// D are the numbers it reads, port after port; states are deviations from the operating point.
struct LinearBlock {
  enum class Kind {
    algebraic,
    continuous,  ///< x' = A x + B u
    sampled,     ///< at its samples x := A x + B u
    delay        ///< y(t) = u(t - delay), as D and `delay`
  };
  Kind kind = Kind::algebraic;
  Eigen::MatrixXd A, B, C, D;
  double delay = 0;  ///< s
  std::vector<std::string> states;
  std::vector<Number> inputs, outputs;
  std::vector<int> group_of_output;  ///< the call that computes the row
};

/// The slopes of block `index` of a run whose signals are computed, with modes held and at constant time.
/// Adds to `notes`.
LinearBlock linearize_block(const Run<double>& run, int index, std::vector<LinearizationNote>& notes);

}  // namespace loopwright
