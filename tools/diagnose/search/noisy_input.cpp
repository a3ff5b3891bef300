#include "tools/diagnose/search/noisy_input.h"
#include <algorithm>

namespace loopwright::diagnosis {
namespace {

bool is_late(const Member& member) {
  return member.candidate->acts == Acts::input && member.candidate->amplitude_is_one;
}

/// Takes a share of what the input is above its mean over some rows away from it.
Candidate unfelt_noise() {
  Candidate candidate;
  candidate.name = "unfelt_noise", candidate.acts = Acts::input;
  candidate.linear = {{"share", "1", 0, 1.2, false, {}}};
  candidate.nonlinear = {{"rows", "1", 1, 300, true, {2, 8, 32, 128}}};
  candidate.columns_at = [](const Path& path, const std::vector<std::vector<double>>& shapes) {
    std::vector<Columns> result;
    for (const std::vector<double>& shape : shapes) {
      const std::vector<double> mean = mean_over_rows(path.input, shape[0]);
      std::vector<float> above(mean.size());
      for (size_t k = 0; k < above.size(); ++k) above[k] = float(path.input[k] - mean[k]);
      result.push_back({Column(std::move(above))});
    }
    return result;
  };
  return candidate;
}

}  // namespace

std::optional<InputNoise> noise_instead_of_late_input(Trials& trials, const Conclusion& conclusion,
                                                      size_t catalogue) {
  const Estimate& found = conclusion.estimate;
  std::vector<Member> others = found.members;
  if (trials.has_map() || std::erase_if(others, is_late) == 0) return {};
  constexpr int iterations = 6;
  const Candidate candidate = unfelt_noise();
  double least = criterion(trials, found, catalogue);
  std::optional<InputNoise> best;
  for (const double rows : candidate.nonlinear[0].grid) {
    std::vector<Member> members = others;
    members.push_back({&candidate, {0.5}, {rows}});
    const Estimate trial = with_own_noise(
        trials, fit_members(trials, members, found.noise, found.motion, iterations), iterations);
    if (!trial.is_valid || criterion(trials, trial, catalogue) >= least) continue;
    least = criterion(trials, trial, catalogue);
    best = InputNoise{trial.members.back().nonlinear[0], trial.members.back().linear[0]};
  }
  return best;
}

}  // namespace loopwright::diagnosis
