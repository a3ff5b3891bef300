#include "tools/diagnose/search/flights.h"
#include <algorithm>
#include <cmath>
#include <optional>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/gaps.h"
#include "tools/diagnose/search/whiteness.h"

namespace loopwright::diagnosis {
namespace {

constexpr int iterations_in_flight = 4;
/// A parameter of the contact that is farther from the usual one than by this factor is doubted.
constexpr double far_from_usual = 1.5;

/// [-2 ln L] Another load must explain so much more.
constexpr double least_gain_of_other_load = 10;
/// Of one load to the next that is tried, and how often in one direction.
constexpr double heavier = 1.6;
constexpr int most_heavier = 3;
/// Gaps within this factor of the present one are tried, because loads were found in half of their gaps; then
/// some steps around the best of them, from one of which a fit reaches the maximum.
constexpr double gaps_around = 4, step_around = 1.025;
constexpr int steps_around = 2;

/// The load that flies; the number of members if there is none.
size_t flying_in(const std::vector<Member>& members) {
  const auto flies = [](const Member& m) { return bool(m.candidate->switched_load); };
  return size_t(std::ranges::find_if(members, flies) - members.begin());
}

/// All shapes of a load but the first one, the gap, as they usually are; whether one of them was far from it.
bool begin_anew(Member& load) {
  bool was_far = false;
  for (size_t i = 1; i < load.nonlinear.size(); ++i) {
    const double usual = load.candidate->nonlinear[i].start;
    was_far |= std::abs(std::log(load.nonlinear[i] / usual)) > std::log(far_from_usual);
    load.nonlinear[i] = usual;
  }
  return was_far;
}

/// The same contact with another load.
void change_load(Member& load, double factor) {
  for (size_t i = 0; i < load.linear.size(); ++i)
    load.linear[i] =
        std::clamp(factor * load.linear[i], load.candidate->linear[i].low, load.candidate->linear[i].high);
  if (load.nonlinear.size() < 2) return;
  const CandidateParameter& frequency = load.candidate->nonlinear[1];
  load.nonlinear[1] = std::clamp(load.nonlinear[1] / std::sqrt(factor), frequency.low, frequency.high);
}

/// Fits members that begin elsewhere, unless too much was tried before; whether they do clearly better.
bool take_if_better(Trials& trials, Estimate& best, std::vector<Member> members) {
  if (trials.work->is_spent(criteria::work_with_rivals)) return false;
  const double worst = best.profile - least_gain_of_other_load;
  Estimate other =
      fit_members(trials, std::move(members), best.noise, best.motion, iterations_in_flight, worst);
  if (!other.is_valid || other.profile > worst) return false;
  best = std::move(other);
  return true;
}

/// A heavier and a lighter load on the same flank push alike for a moment: where the errors are not white,
/// both are tried.
Estimate with_other_loads(Trials& trials, Estimate best) {
  if (!best.is_valid || portmanteau(trials, *best.fitted) <= 2 * criteria::portmanteau_lags) return best;
  for (const double factor : {heavier, 1 / heavier})
    for (int n = 0; n < most_heavier; ++n) {
      std::vector<Member> members = best.members;
      change_load(members[flying_in(members)], factor);
      if (!take_if_better(trials, best, std::move(members))) break;
    }
  return best;
}

/// And another gap, where they still are not.
Estimate with_other_gaps(Trials& trials, Estimate best) {
  if (!best.is_valid || portmanteau(trials, *best.fitted) <= 2 * criteria::portmanteau_lags) return best;
  for (std::vector<Member>& members : other_gaps(trials, best, flying_in(best.members)))
    take_if_better(trials, best, std::move(members));
  return best;
}

/// That of these gaps in which the members, as they are otherwise, explain most. Empty: in none clearly more.
std::optional<double> best_gap(Trials& trials, const Estimate& estimate, const std::vector<double>& gaps) {
  std::optional<double> best;
  double least = estimate.profile - least_gain_of_other_load;
  std::vector<Member> members = estimate.members;
  for (const double gap : gaps) {
    if (trials.work->is_spent(criteria::work_with_rivals)) break;
    members[flying_in(members)].nonlinear[0] = gap;
    const Estimate other = fit_members(trials, members, estimate.noise, estimate.motion, 0);
    if (other.is_valid && other.profile < least) least = other.profile, best = gap;
  }
  return best;
}

/// And the gaps around it, in flight: moved along the path, without the moments of its blows, a load promises
/// too little in the right gap.
Estimate with_gaps_around(Trials& trials, Estimate best) {
  if (!best.is_valid || portmanteau(trials, *best.fitted) <= 2 * criteria::portmanteau_lags) return best;
  const size_t load = flying_in(best.members);
  const CandidateParameter& range = best.members[load].candidate->nonlinear[0];
  const double present = best.members[load].nonlinear[0];
  std::vector<double> gaps, fine;
  for (const double gap : range.grid)
    if (std::abs(std::log(gap / present)) < std::log(gaps_around)) gaps.push_back(gap);
  const auto coarse = best_gap(trials, best, gaps);
  if (!coarse) return best;
  for (int step = -steps_around; step <= steps_around; ++step)
    fine.push_back(std::clamp(*coarse * std::pow(step_around, step), range.low, range.high));
  std::vector<Member> members = best.members;
  members[load].nonlinear[0] = best_gap(trials, best, fine).value_or(*coarse);
  if (!take_if_better(trials, best, std::move(members))) return best;
  best = with_other_loads(trials, std::move(best));
  std::vector<Member> usual = best.members;
  if (begin_anew(usual[load])) take_if_better(trials, best, std::move(usual));
  return best;
}

}  // namespace

Estimate fitted_in_flight(Trials& trials, Estimate found) {
  const size_t load = flying_in(found.members);
  if (load == found.members.size()) return found;
  std::vector<Member> members = found.members;
  const bool was_far = begin_anew(members[load]);
  Estimate best = fit_members(trials, found.members, found.noise, found.motion, iterations_in_flight);
  if (was_far) {
    Estimate other = fit_members(trials, std::move(members), found.noise, found.motion, iterations_in_flight);
    if (other.is_valid && (!best.is_valid || other.profile < best.profile)) best = std::move(other);
  }
  best = with_other_gaps(trials, with_other_loads(trials, std::move(best)));
  return with_gaps_around(trials, std::move(best));
}

}  // namespace loopwright::diagnosis
