#include "tools/diagnose/verdict/staircase.h"
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/evidence.h"
#include "tools/diagnose/verdict/unknown_effect.h"

namespace loopwright::diagnosis {
namespace {

bool corrects_nominal(const Member& member) {
  return member.candidate->name == "inertia" || member.candidate->name == "viscous_friction";
}

struct Stage {
  std::vector<size_t> members;  ///< for the conclusion
  Estimate estimate;
  double criterion = 0;
  double force = 0;  ///< the residual that remains, over the fitted rows
};

class Climb {
 public:
  Climb(Trials& trials, const Conclusion& conclusion, const std::vector<InverseDynamics>& inverse,
        size_t catalogue)
      : trials_(trials), conclusion_(conclusion), inverse_(inverse), catalogue_(catalogue) {}

  /// All members first, the empty set last.
  std::vector<Stage> stages() {
    std::vector<Stage> list;
    Stage whole{{}, conclusion_.estimate, criterion(trials_, conclusion_.estimate, catalogue_)};
    for (size_t m = 0; m < conclusion_.estimate.members.size(); ++m) whole.members.push_back(m);
    list.push_back(std::move(whole));
    while (!list.back().members.empty()) list.push_back(without_least(list.back()));
    return list;
  }

 private:
  Stage fitted(const std::vector<size_t>& members, const Estimate& near) {
    std::vector<Member> values;
    for (size_t m : members) values.push_back(conclusion_.estimate.members[m]);
    Stage stage{members, fit_members(trials_, values, conclusion_.estimate.noise, near.motion, 8), 0};
    stage.criterion = criterion(trials_, stage.estimate, catalogue_);
    stage.force = residual_size(trials_, inverse_, stage.estimate.members).fitted;
    return stage;
  }
  Stage without_least(const Stage& from) {
    const auto is_correction = [&](size_t m) { return corrects_nominal(conclusion_.estimate.members[m]); };
    const bool only_corrections = std::ranges::all_of(from.members, is_correction);
    std::vector<Stage> stages;
    for (size_t m : from.members) {
      if (is_correction(m) && !only_corrections) continue;
      std::vector<size_t> rest;
      std::ranges::copy_if(from.members, std::back_inserter(rest), [&](size_t other) { return other != m; });
      stages.push_back(fitted(rest, from.estimate));
    }
    return with_own_noise(without_idle_corrections(simplest_of_best(std::move(stages)), is_correction));
  }
  /// Of those that balance the forces alike the one with the fewest parameters.
  static Stage simplest_of_best(std::vector<Stage> stages) {
    const double least = std::ranges::min(stages, {}, &Stage::force).force;
    std::erase_if(stages, [&](const Stage& stage) { return stage.force > criteria::same_step * least; });
    const auto size = [](const Stage& stage) {
      size_t parameters = 0;
      for (const Member& member : stage.estimate.members) parameters += parameters_of(*member.candidate);
      return std::pair(parameters, stage.force);
    };
    return std::move(*std::ranges::min_element(stages, {}, size));
  }
  /// The force that this stage lacks is larger than the final noise, and no slow force of an amplifier: one
  /// that followed it would leave nothing of it to the members that could explain a part.
  Stage with_own_noise(Stage stage) {
    const Estimate& e = stage.estimate;
    Noise noise = e.noise;
    noise.step = criteria::next_to_no_slow_noise * noise.white * std::sqrt(1 - noise.memory * noise.memory);
    noise = fit_noise(trials_, *e.fitted, noise, FreeNoise::white);
    stage.estimate = fit_members(trials_, e.members, noise, e.motion, 8);
    stage.force = residual_size(trials_, inverse_, stage.estimate.members).fitted;
    return stage;
  }
  /// Of the remaining members, corrections without a benefit of their own are removed too.
  template <class F> Stage without_idle_corrections(Stage stage, F&& is_correction) {
    for (size_t i = 0; i < stage.members.size(); ++i) {
      if (!is_correction(stage.members[i])) continue;
      std::vector<size_t> rest = stage.members;
      rest.erase(rest.begin() + std::ptrdiff_t(i));
      Stage without = fitted(rest, stage.estimate);
      const double n = double(fitted_numbers(trials_));
      const bool lowers_the_force = stage.force < criteria::least_benefit_of_a_correction * without.force;
      const double gain = without.criterion - stage.criterion;
      if (lowers_the_force && gain > criteria::least_gain_of_a_correction_per_row * n) continue;
      return without_idle_corrections(std::move(without), is_correction);
    }
    return stage;
  }

  Trials& trials_;
  const Conclusion& conclusion_;
  const std::vector<InverseDynamics>& inverse_;
  const size_t catalogue_;
};

/// Members at the end that hardly improve the error, neither over the fitted rows nor over those held out,
/// are optional: what was held out need not contain every motion.
void mark_knee(std::vector<DiagnosisStep>& steps) {
  const auto is_small = [&](double DiagnosisStep::*error, size_t i) {
    const double whole = steps.front().*error - steps.back().*error;
    return steps[i - 1].*error - steps[i].*error <= criteria::knee * whole;
  };
  // Small beside what was missing first, but without it much more is left than all leave.
  const auto is_missed = [&](double DiagnosisStep::*error, size_t i) {
    const double least = steps.back().*error;
    return least == 0 || steps[i - 1].*error > criteria::most_left_by_optional * least;
  };
  for (size_t i = steps.size(); i-- > 1;) {
    if (!is_small(&DiagnosisStep::force_rmse, i) || !is_small(&DiagnosisStep::held_out_force_rmse, i)) break;
    if (is_missed(&DiagnosisStep::force_rmse, i) && is_missed(&DiagnosisStep::held_out_force_rmse, i)) break;
    steps[i].is_optional = true;
  }
}

}  // namespace

size_t Staircase::necessary() const {
  size_t count = steps.size();
  while (count > 1 && steps[count - 1].is_optional) --count;
  return count;
}

std::string shown_name(const Candidate& candidate) {
  return candidate.is_unknown ? "an unknown force of " + candidate.form : candidate.name;
}

std::string shown_name(const Member& member, const Trials& trials) {
  if (!member.candidate->jumps) return shown_name(*member.candidate);
  const AxisRecord& record = trials.list.front().model->record();
  return "a force that jumps at " + told_instant(record.start + member.nonlinear[0], record.sample_time);
}

Staircase climb(Trials& trials, const Conclusion& conclusion, const std::vector<InverseDynamics>& inverse,
                size_t catalogue) {
  Staircase result;
  std::vector<Stage> stages = Climb(trials, conclusion, inverse, catalogue).stages();
  std::ranges::reverse(stages);
  std::vector<size_t> before;
  for (const Stage& stage : stages) {
    DiagnosisStep step;
    std::vector<size_t> added;
    for (size_t m : stage.members)
      if (std::ranges::find(before, m) == before.end()) added.push_back(m);
    std::ranges::stable_sort(added, {},
                             [&](size_t m) { return corrects_nominal(conclusion.estimate.members[m]); });
    result.members.push_back(stage.estimate.members), result.added.push_back(added);
    for (size_t m : added)
      step.added.push_back(shown_name(conclusion.estimate.members[m], trials)), result.order.push_back(m);
    const ResidualSize size = residual_size(trials, inverse, stage.estimate.members);
    step.force_rmse = size.fitted, step.held_out_force_rmse = size.held_out;
    before = stage.members;
    result.steps.push_back(std::move(step));
  }
  if (result.steps.size() > 1) mark_knee(result.steps);
  return result;
}

}  // namespace loopwright::diagnosis
