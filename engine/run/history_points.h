/// How many points of a solver step the blocks that interpolate their past must store.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>
#include "engine/run/run.h"

namespace loopwright {

/// A solver step may be as long as a delay: its end alone does not represent the signal inside it.
class HistoryPoints {
 public:
  explicit HistoryPoints(const Run<double>& run) {
    const Plan& plan = run.plan();
    for (size_t b = 0; b < plan.blocks.size(); ++b) {
      const Plan::Block& block = plan.blocks[b];
      if (!block.type->kernels.accept || block.type->info.buffers == 0) continue;
      const double most = block.type->info.buffer_length(run.call(int(b)).block, 0);
      for (const auto& port : block.inputs)
        for (Number n : port) inputs_.push_back({n, most});
    }
  }
  /// The number of equal pieces of a step over which every stored signal is linear within the tolerances of
  /// the plan. `look(i, n)` computes the signals at the i-th of n pieces.
  ///
  /// Linear interpolation errs by d/8, where d is the second difference between neighbors; d falls with 1/n².
  template <class Look> int pieces(const Run<double>& run, Look&& look) {
    if (inputs_.empty()) return 1;
    constexpr int measured = 4;
    double pieces = 1;
    for (int i = 0; i <= measured; ++i) {
      look(i, measured);
      for (Input& in : inputs_) {
        const double value = run.number(in.number);
        if (i > 1) {
          const double error = std::fabs(value - 2 * in.before + in.before_that) / 8;
          const double tolerance =
              run.plan().absolute_tolerance + run.plan().relative_tolerance * std::fabs(in.before);
          pieces = std::fmax(pieces, std::fmin(in.most, std::ceil(measured * std::sqrt(error / tolerance))));
        }
        in.before_that = in.before, in.before = value;
      }
    }
    return int(pieces);
  }

 private:
  struct Input {
    Number number;
    double most;  ///< points that the block can store
    double before = 0, before_that = 0;
  };
  std::vector<Input> inputs_;
};

}  // namespace loopwright
