#include "tools/diagnose/search/prune.h"
#include <algorithm>

namespace loopwright::diagnosis {
namespace {

constexpr int iterations = 4;

}  // namespace

Estimate pruned(Trials& trials, Estimate estimate, const Noise& noise, size_t catalogue) {
  constexpr double worth_a_fit = -10;  // [criterion] gain of a removal, as linearized, that is tried
  while (estimate.is_valid && estimate.members.size() > 1) {
    const Evidence evidence(trials, estimate, {}, catalogue);
    const std::vector<double> gains = evidence.gains_of_removal(double(fitted_numbers(trials)));
    const size_t worst = size_t(std::ranges::max_element(gains) - gains.begin());
    if (gains[worst] < worth_a_fit) break;
    Estimate without =
        fit_members(trials, without_one(estimate.members, worst), noise, estimate.motion, iterations);
    if (!without.is_valid || criterion(trials, without, catalogue) > criterion(trials, estimate, catalogue))
      break;
    estimate = std::move(without);
  }
  return estimate;
}

std::optional<Estimate> without_uncertain_delay(Trials& trials, const Estimate& estimate,
                                                const std::vector<Weight>& weights) {
  for (size_t m = 0; m < estimate.members.size(); ++m) {
    if (!is_late_input(*estimate.members[m].candidate) || weights[m].loss >= 0) continue;
    Estimate without =
        fit_members(trials, without_one(estimate.members, m), estimate.noise, estimate.motion, iterations);
    if (without.is_valid) return without;
  }
  return {};
}

}  // namespace loopwright::diagnosis
