/// How long the limits of blocks hold during a run: saturations, controllers with limits.
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "engine/plan/plan.h"
#include "engine/record/recording.h"

namespace loopwright {

/// The output that blocks of this type hold between their parameters "low" and "high"; empty: there is none.
/// The names alone do not tell: the stops of an EndStop bound its input, and a PulseTrain changes between two
/// levels.
std::string_view limited_output(std::string_view type);

/// The share of time that a block spends at a limit.
struct TimeAtLimit {
  std::string block;         ///< "controller", "saturation[1]"
  double low = 0, high = 0;  ///< of the time of the run, 0 to 1

  double share() const { return low + high; }
};

/// A plan whose recording also has the limited outputs that are not in its log, in additional columns at the
/// end.
class WatchedLimits {
 public:
  /// Every block, and every element of a block wired with vectors, of which a limit is finite; no more than
  /// the memory for their columns allows.
  explicit WatchedLimits(const Plan& plan);

  const Plan& plan() const { return plan_; }
  /// Removes the additional columns and returns what they say.
  std::vector<TimeAtLimit> take(Recording& recording) const;
  size_t watched() const { return limits_.size(); }
  size_t left_out() const { return left_out_; }

 private:
  struct Limit {
    std::string block;
    double low, high;
    size_t column;  ///< of the recording
  };
  Plan plan_;
  std::vector<Limit> limits_;
  size_t columns_ = 0;  ///< of the recording without the additional ones
  size_t left_out_ = 0;
};

}  // namespace loopwright
