/// How long the limits of blocks hold during a run: saturations, controllers with limits.
#pragma once
#include <string>
#include <vector>
#include "engine/plan/plan.h"
#include "engine/record/recording.h"

namespace loopwright {

/// The share of time that a block spends at a limit.
struct TimeAtLimit {
  std::string block;         ///< "controller.command"
  double low = 0, high = 0;  ///< of the time of the run, 0 to 1
};

/// A plan whose recording also has the outputs of blocks with limits, in additional columns at the end.
class WatchedLimits {
 public:
  /// Blocks with parameters "low" and "high" of which one is finite; the first 32 of them.
  explicit WatchedLimits(const Plan& plan);

  const Plan& plan() const { return plan_; }
  /// Removes the additional columns and returns what they say.
  std::vector<TimeAtLimit> take(Recording& recording) const;

 private:
  struct Limit {
    std::string block;
    double low, high;
  };
  Plan plan_;
  std::vector<Limit> limits_;  ///< of the additional columns, in their order
};

}  // namespace loopwright
