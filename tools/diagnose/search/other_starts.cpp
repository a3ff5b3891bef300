#include "tools/diagnose/search/other_starts.h"
#include <algorithm>
#include <cmath>

namespace loopwright::diagnosis {
namespace {

constexpr double shares[] = {0.1, 0.2, 0.4, 0.7};  // of the load in the mass of the machine
constexpr double factors[] = {0.8, 1.25};          // of a distance: a third apart is a point of the grid

}  // namespace

std::vector<std::vector<Member>> starts_of_load(const std::vector<Member>& members, double machine_mass) {
  std::vector<std::vector<Member>> starts;
  if (!members.back().candidate->linear_load || !is_own_load(members.back())) return starts;
  for (const double share : shares) {
    std::vector<Member> other = members;
    Member& load = other.back();
    const Candidate& candidate = *load.candidate;
    const double heavier = share * machine_mass / -candidate.added_inertia(load);
    for (size_t i = 0; i < load.linear.size(); ++i)
      load.linear[i] =
          std::clamp(heavier * load.linear[i], candidate.linear[i].low, candidate.linear[i].high);
    const CandidateParameter& frequency = candidate.nonlinear[0];
    load.nonlinear[0] = std::clamp(load.nonlinear[0] * std::sqrt(1 - share), frequency.low, frequency.high);
    starts.push_back(std::move(other));
  }
  return starts;
}

std::vector<std::vector<Member>> starts_of_hysteresis(const std::vector<Member>& members) {
  std::vector<std::vector<Member>> starts;
  for (size_t m = 0; m < members.size(); ++m) {
    const Candidate& candidate = *members[m].candidate;
    if (!is_dry_friction(candidate) || candidate.at_rest != AtRest::gives || candidate.nonlinear.empty())
      continue;
    const CandidateParameter& distance = candidate.nonlinear[0];
    for (const double factor : factors) {
      std::vector<Member> other = members;
      other[m].nonlinear[0] = std::clamp(factor * other[m].nonlinear[0], distance.low, distance.high);
      starts.push_back(std::move(other));
    }
  }
  return starts;
}

}  // namespace loopwright::diagnosis
