#include "tools/diagnose/search/flights.h"
#include <algorithm>
#include <cmath>

namespace loopwright::diagnosis {
namespace {

constexpr int iterations_in_flight = 4;
/// A parameter of the contact that is farther from the usual one than by this factor is doubted.
constexpr double far_from_usual = 1.5;

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

}  // namespace

Estimate fitted_in_flight(Trials& trials, Estimate found) {
  const auto flies =
      std::ranges::find_if(found.members, [](const Member& m) { return bool(m.candidate->switched_load); });
  if (flies == found.members.end()) return found;
  std::vector<Member> members = found.members;
  const bool was_far = begin_anew(members[size_t(flies - found.members.begin())]);
  Estimate best = fit_members(trials, found.members, found.noise, found.motion, iterations_in_flight);
  if (!was_far) return best;
  Estimate other = fit_members(trials, std::move(members), found.noise, found.motion, iterations_in_flight);
  return other.is_valid && (!best.is_valid || other.profile < best.profile) ? other : best;
}

}  // namespace loopwright::diagnosis
