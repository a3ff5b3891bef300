/// Effects that are linear in one held signal and in its past, as a delay of the command is: a row of theirs
/// is a sum over a few rows before it.
#pragma once
#include <deque>
#include <memory>
#include <span>
#include <utility>
#include <vector>
#include "tools/effects/effect_lanes.h"

namespace loopwright {

/// What such an effect answers to a signal of one at the first row, row by row until it is over.
struct HeldResponse {
  struct Row {
    size_t after;
    double mean, slope;
  };
  std::vector<Row> rows;

  double mean(std::span<const double> signal, size_t row) const;
  double slope(std::span<const double> signal, size_t row) const;
};

class HeldEffect {
 public:
  explicit HeldEffect(std::shared_ptr<const EffectPlan> plan);

  /// To these fitted parameters. A fit asks for the same along many motions: the last few are remembered.
  std::shared_ptr<const HeldResponse> response(const std::vector<double>& fitted);
  /// For so many a signal can be remembered: what a response costs.
  size_t remembered_rows() const { return size_t(plan_->plan.buffer_numbers) + 2; }
  /// The one that the effect reads.
  std::span<const double> signal(const RoleSignals& signals) const;

 private:
  friend bool is_held(const std::shared_ptr<const EffectPlan>& plan);
  struct Value {
    double mean, slope;
  };
  std::vector<Value> run(const std::vector<double>& fitted, const std::vector<double>& signal);
  bool superposes(const std::vector<double>& fitted);

  std::shared_ptr<const EffectPlan> plan_;
  EffectLanes lanes_;
  std::deque<std::pair<std::vector<double>, std::shared_ptr<const HeldResponse>>>
      known_;  // the last one at the end
};

/// Whether the blocks remember only samples of one held signal, taken once a row, and superposition holds at
/// typical values and at both ends of the ranges of the parameters.
bool is_held(const std::shared_ptr<const EffectPlan>& plan);

}  // namespace loopwright
