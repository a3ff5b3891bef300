#include "tools/diagnose/search/late_log.h"
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include "engine/record/excerpt.h"
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

/// Takes a share of the difference from the input some rows later.
Candidate early_input(size_t rows) {
  Candidate candidate;
  candidate.name = "early_input", candidate.acts = Acts::input;
  candidate.linear = {{"share", "1", 0, 2, false, {}}};
  candidate.columns_at = [rows](const Path& path, const std::vector<std::vector<double>>& shapes) {
    const std::vector<double> later = moved_earlier(path.input, rows);
    std::vector<float> difference(later.size());
    for (size_t k = 0; k < later.size(); ++k) difference[k] = float(path.input[k] - later[k]);
    return std::vector<Columns>(shapes.size(), {Column(std::move(difference))});
  };
  return candidate;
}

/// One of each kind, for as long as the members that refer to it.
const std::array<Candidate, 2>& early_inputs() {
  static const std::array<Candidate, 2> inputs{early_input(1), early_input(2)};
  return inputs;
}

bool may_be_late(const Trials& trials, const Estimate& found) {
  return !trials.has_map() && std::ranges::none_of(found.members, is_late_member) &&
         std::ranges::all_of(trials.list, [](const Trial& trial) {
           const AxisRecord& record = trial.model->record();
           return !record.is_thinned && record.rows_late == 0;
         });
}

/// Whether an early input, the first of the members, explains anything beside the noise as it was found.
/// Where it does not, no other noise makes it, and to fit that takes by far the most time.
bool explains_anything(Trials& trials, const std::vector<Member>& members, const Estimate& found) {
  constexpr double least_gain = 3.84;  // in -2 ln L: chance gains as much in one of 20
  return found.profile - fit_members(trials, members, found.noise, found.motion, 1).profile > least_gain;
}

}  // namespace

std::optional<size_t> rows_logged_late(Trials& trials, const Estimate& found,
                                       std::vector<std::string>& trail) {
  constexpr int iterations = 6;
  if (!may_be_late(trials, found) || trials.work->is_spent(criteria::work_with_rivals)) return {};
  const auto fitted = [&](const std::vector<Member>& members) {
    return with_own_noise(trials, fit_members(trials, members, found.noise, found.motion, iterations),
                          iterations);
  };
  std::optional<double> recorded;
  double most = criteria::least_gain_of_other_input;  // the share decides: small gains are as certain of it
  std::optional<size_t> late;
  for (size_t i = 0; i < early_inputs().size(); ++i) {
    std::vector<Member> members = found.members;
    members.insert(members.begin(), Member{&early_inputs()[i], {1}, {}});
    if (!explains_anything(trials, members, found)) continue;
    if (!recorded) recorded = fitted(found.members).misfit();
    const Estimate trial = fitted(members);
    const double gain = *recorded - trial.misfit();
    if (!(gain > most)) continue;
    const double share = trial.members.front().linear.front();
    trail.push_back(fmt::format("the input of {} rows later: share {:.2f}, gain {:.1f}", i + 1, share, gain));
    const bool is_whole = std::abs(share - 1) < criteria::most_beside_a_row;
    // A part of that of two rows later that explains more than all of that of one is a lead of the motor.
    late = is_whole ? std::optional(i + 1) : std::nullopt, most = gain;
  }
  return late;
}

}  // namespace loopwright::diagnosis
