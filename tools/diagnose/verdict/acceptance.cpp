#include "tools/diagnose/verdict/acceptance.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/doubt.h"
#include "tools/diagnose/search/merged_rows.h"
#include "tools/diagnose/search/rivals.h"
#include "tools/diagnose/search/wandering_sensor.h"
#include "tools/diagnose/search/whiteness.h"
#include "tools/diagnose/wording.h"

namespace loopwright::diagnosis {
namespace {

struct Refusal {
  size_t member;
  std::string why;
  bool is_of_sensor = false;
};

/// Whether a part of the mass moves by itself. Its motion is not measured, and swings on from window to
/// window; where it is at the beginning of one decides more than whether it exists. This is no excuse for a
/// load with a parameter at the end of its range, which stands for something else.
bool has_own_load(const std::vector<Member>& members) {
  return std::ranges::any_of(members, [](const Member& m) { return is_own_load(m) && !is_at_limit(m); });
}

class Judge {
 public:
  Judge(Trials& trials, const std::vector<InverseDynamics>& inverse, const Improver& improver,
        const LoadOptions& load)
      : trials_(trials), inverse_(inverse), improver_(improver), load_(load) {}

  /// A step of the staircase that cannot be run counts as one that diverges: where an effect is still
  /// missing, another is fitted in its place. The last one must run.
  void run(Acceptance& state) {
    state.runs.clear(), state.why_not_run.clear(), runs_until_ = 0;
    for (size_t i = 0; i < state.staircase.members.size(); ++i) {
      state.runs.push_back(diverged());
      try {
        state.runs.back() = run_freely(state.staircase.members[i], improver_, load_, trials_, inverse_,
                                       state.conclusion.estimate.noise);
        state.why_not_run.clear(), runs_until_ = i + 1;
      } catch (const InputError& error) {
        state.why_not_run = "the diagram with the effects cannot be run: " + error.problems.text();
      }
    }
  }

  std::optional<Refusal> refused(const Acceptance& state) {
    // A block has limits too: with less than no damping there is no such machine.
    if (!state.why_not_run.empty()) {
      if (runs_until_ == 0) return {};
      return Refusal{state.staircase.added[runs_until_].front(), "the diagram cannot be run with it"};
    }
    for (size_t i = 1; i < state.runs.size(); ++i)
      if (is_worse(state.runs[i - 1], state.runs[i]) && is_judged_by_simulation(state, i) &&
          !is_answered(state, i) && is_worse_without(state, state.staircase.added[i].front()))
        return why_worse(state, i);
    for (size_t i = 1; i < state.runs.size(); ++i)
      if (helps_nowhere(state, i) && !brings_own_load(state, i) && !is_answered(state, i) &&
          helps_nowhere_beside_all(state, state.staircase.added[i].front()) &&
          !makes_errors_white(state, state.staircase.added[i].front()))
        return Refusal{state.staircase.added[i].front(),
                       "neither does the diagram simulate better with it, nor do the forces balance better"};
    if (state.conclusion.counts_portmanteau > criteria::most_portmanteau_of_counted && !state.runs.empty())
      for (size_t m = 0; m < state.conclusion.estimate.members.size(); ++m)
        if (!helps(state, m) && !is_late(state, m) && may_be_of_counts(state, m))
          return Refusal{
              m,
              "the counts of the sensor beat with the samples, which resembles it, and the diagram "
              "simulates no better with it"};
    if (may_be_doubtful(state.conclusion.estimate.members) && !state.runs.empty())
      for (size_t i = 1; i < state.runs.size(); ++i)
        for (size_t m : state.staircase.added[i])
          if (state.staircase.steps[i].is_optional && !is_own_load(state.conclusion.estimate.members[m]) &&
              !helps(state, m) && !makes_errors_white(state, m))
            return Refusal{m,
                           "what a load that flies leaves after its blows resembles it, and the diagram "
                           "simulates no better with it"};
    if (const auto refusal = fine_pattern_of_noise(state)) return refusal;
    for (size_t i = 1; i < state.runs.size(); ++i)
      for (size_t m : state.staircase.added[i])
        if (state.conclusion.weights[m].certainty < 1 && !is_worse(state.runs[i], state.runs[i - 1]))
          return Refusal{m, "its interval contains zero, and the diagram simulates no worse without it"};
    if (auto refusal = load_of_wandering_sensor(state)) return refusal;
    return smaller_than_what_is_left(state);
  }

  bool is_worse_than_nominal(const Acceptance& state) {
    std::vector<size_t> all(state.conclusion.estimate.members.size());
    std::iota(all.begin(), all.end(), size_t(0));
    const FreeRun &before = state.runs.front(), &after = state.runs.back();
    return is_worse(before, after) && !is_answered(state, all, before, after);
  }

 private:
  std::optional<Refusal> fine_pattern_of_noise(const Acceptance& state) const {
    for (size_t i = 1; i < state.runs.size(); ++i) {
      const DiagnosisStep &before = state.staircase.steps[i - 1], &after = state.staircase.steps[i];
      if (!after.is_optional || after.force_rmse < (1 - criteria::least_help) * before.force_rmse) continue;
      for (size_t m : state.staircase.added[i]) {
        const Member& member = state.conclusion.estimate.members[m];
        if (member.candidate->is_periodic && !member.candidate->repeats_in_time &&
            member.nonlinear[0] < member.candidate->fine_pitch)
          return Refusal{m, "its pitch passes within a few rows, and the forces balance no better with it"};
      }
    }
    return {};
  }
  std::optional<Refusal> load_of_wandering_sensor(const Acceptance& state) {
    // Counts that beat with the samples resemble such an offset too.
    if (state.conclusion.counts_portmanteau > criteria::most_portmanteau_of_counted) return {};
    const Estimate& found = state.conclusion.estimate;
    const auto load = std::ranges::find_if(found.members, is_own_load);
    if (load == found.members.end()) return {};
    const auto sensor = wandering_sensor(trials_, found);
    if (!sensor || sensor->gain <= criteria::least_gain_of_offset) return {};
    return Refusal{size_t(load - found.members.begin()), described(trials_, *sensor), true};
  }
  /// Where the errors pass for noise, the forces along the smooth motion may still leave more than that
  /// noise: a mode far above it, or an input between its rows, answers as a little mass or damping does. An
  /// effect that is smaller than this may be no more than a part of it. In right answers what is left was at
  /// most half of the smallest effect.
  std::optional<Refusal> smaller_than_what_is_left(const Acceptance& state) const {
    const Conclusion& c = state.conclusion;
    const auto is_beside_balance = [](const Member& m) {
      return is_own_load(m) || m.candidate->flies || m.candidate->acts == Acts::sensor;
    };
    if (!c.is_white() || trials_.has_map() || !balances_forces(trials_, inverse_) ||
        std::ranges::any_of(c.estimate.members, is_beside_balance))
      return {};
    constexpr double clearly_more = 1.05;  // than noise, whose size is known no better
    const double left = state.staircase.steps.back().force_rmse, noise = residual_floor(trials_, c.estimate);
    if (left < clearly_more * noise) return {};
    const double beside_noise = std::sqrt(left * left - noise * noise);
    const auto [least, most] = std::ranges::minmax_element(c.weights, {}, &Weight::force_rms);
    if (c.weights.empty() || least->force_rms >= beside_noise || most->force_rms <= beside_noise) return {};
    return Refusal{size_t(least - c.weights.begin()),
                   fmt::format("the forces leave {} beside the noise, and it makes less: it may only make up "
                               "for a part of that",
                               shown(beside_noise, trials_.list.front().model->force_unit()))};
  }
  bool may_be_of_counts(const Acceptance& state, size_t member) const {
    const Weight& weight = state.conclusion.weights[member];
    return weight.counts == 0 || weight.counts >= criteria::least_feigned_by_counts * weight.wald;
  }
  bool is_late(const Acceptance& state, size_t member) const {
    return is_late_in_slow_balance(trials_, state.conclusion.estimate.members, member);
  }
  /// What the controller answered to noise is in the recorded input, but not in the motion that is simulated:
  /// beside it, an input that is late for sure may simulate a little worse.
  bool is_answered(const Acceptance& state, const std::vector<size_t>& added, const FreeRun& before,
                   const FreeRun& after) const {
    return after.rmse() < criteria::most_worse_by_answers * before.rmse() &&
           std::ranges::any_of(added, [&](size_t m) { return is_late(state, m); });
  }
  bool is_answered(const Acceptance& state, size_t step) const {
    return is_answered(state, state.staircase.added[step], state.runs[step - 1], state.runs[step]);
  }
  /// Whether all effects together simulate worse than all others. In the middle of the staircase an effect
  /// may only lack its companion: friction that is fitted beside a drift without a name spoils other rows.
  bool is_worse_without(const Acceptance& state, size_t member) {
    return is_worse(without_member(state, member).second, state.runs.back());
  }
  /// The others, fitted again, and their simulation.
  std::pair<Estimate, FreeRun> without_member(const Acceptance& state, size_t member) {
    const Estimate& e = state.conclusion.estimate;
    Estimate others = fit_members(trials_, without_one(e.members, member), e.noise, e.motion, iterations);
    FreeRun run = run_of(others.members, e.noise);
    return {std::move(others), std::move(run)};
  }
  /// A diagram that cannot be run with them counts as one that diverges.
  FreeRun run_of(const std::vector<Member>& members, const Noise& noise) {
    try {
      return run_freely(members, improver_, load_, trials_, inverse_, noise);
    } catch (const InputError&) {
      return diverged();
    }
  }
  static FreeRun diverged() {
    FreeRun none;
    none.diverged = true;
    return none;
  }
  /// A load that moves by itself may begin a window wrongly. A late input moves it as it moves the motor.
  static bool is_judged_by_simulation(const Acceptance& state, size_t step) {
    if (!has_own_load(state.staircase.members[step])) return true;
    const auto is_late = [&](size_t m) {
      return is_late_input(*state.conclusion.estimate.members[m].candidate);
    };
    return std::ranges::all_of(state.staircase.added[step], is_late);
  }
  /// Beside the same load the others are compared fairly.
  static bool brings_own_load(const Acceptance& state, size_t step) {
    return has_own_load(state.staircase.members[step]) != has_own_load(state.staircase.members[step - 1]);
  }
  static bool helps_nowhere(const Acceptance& state, size_t step) {
    const auto errors = [&](size_t i) {
      const DiagnosisStep& s = state.staircase.steps[i];
      return Errors{state.runs[i].rmse(), s.force_rmse, s.held_out_force_rmse};
    };
    return are_larger(errors(step - 1), errors(step));
  }
  /// All effects against all others.
  bool helps_nowhere_beside_all(const Acceptance& state, size_t member) {
    const auto [others, without] = without_member(state, member);
    const auto errors = [&](const FreeRun& run, const std::vector<Member>& members) {
      const ResidualSize left = residual_size(trials_, inverse_, members);
      return Errors{run.rmse(), left.fitted, left.held_out};
    };
    return are_larger(errors(without, others.members),
                      errors(state.runs.back(), state.conclusion.estimate.members));
  }
  /// In the simulation of the held-out rows; where its force does not occur there, in the balance of the
  /// forces.
  bool helps(const Acceptance& state, size_t member) {
    const auto [others, without] = without_member(state, member);
    const std::vector<Member>& all = state.conclusion.estimate.members;
    const auto helps_by = [](double after, double before) {
      return after < (1 - criteria::least_help) * before;
    };
    if (without.diverged || helps_by(state.runs.back().rmse(), without.rmse())) return true;
    return !is_held_out(trials_, inverse_, all, member) &&
           helps_by(residual_size(trials_, inverse_, all).fitted,
                    residual_size(trials_, inverse_, others.members).fitted);
  }
  /// Beside a load that moves by itself neither simulation nor balance is more than a hint: an effect that
  /// they do not ask for stands where the errors are white with it alone.
  bool makes_errors_white(const Acceptance& state, size_t member) {
    const Conclusion& all = state.conclusion;
    if (!has_own_load(all.estimate.members) || !all.is_white() || all.comes_in_bursts) return false;
    Estimate others = without_member(state, member).first;
    maximise(trials_, others);
    return portmanteau(trials_, *others.fitted) >
           all.most_portmanteau + criteria::reach_of_counts * all.counts_portmanteau;
  }
  Refusal why_worse(const Acceptance& state, size_t step) {
    const std::string& unit = trials_.list.front().model->record().measured.front().unit;
    const FreeRun &before = state.runs[step - 1], &after = state.runs[step];
    const size_t member = state.staircase.added[step].front();
    if (after.diverged) return {member, "the diagram with it diverges when it is simulated"};
    return {member, fmt::format("the diagram simulates worse with it: {} instead of {}",
                                shown(after.rmse(), unit), shown(before.rmse(), unit))};
  }

  static constexpr int iterations = 4;  // of a fit
  Trials& trials_;
  const std::vector<InverseDynamics>& inverse_;
  const Improver& improver_;
  const LoadOptions& load_;
  size_t runs_until_ = 0;  ///< steps, of which the last one runs
};

}  // namespace

void need_what_simulates_better(std::vector<DiagnosisStep>& steps) {
  const double whole = steps.front().simulation_rmse - steps.back().simulation_rmse;
  for (size_t i = steps.size(); i-- > 1;) {
    if (!steps[i].is_optional) return;
    const double gained = steps[i - 1].simulation_rmse - steps[i].simulation_rmse;
    if (!(gained > criteria::most_optional_simulation * whole)) continue;
    for (size_t k = 1; k <= i; ++k) steps[k].is_optional = false;
    return;
  }
}

bool are_larger(const Errors& before, const Errors& after) {
  const auto is_larger = [](double was, double is) {
    return is * is > (1 + criteria::least_worsening) * was * was;
  };
  return is_larger(before.simulation, after.simulation) &&
         (after.held_out_force == 0 ? is_larger(before.force, after.force)
                                    : is_larger(before.held_out_force, after.held_out_force));
}

Acceptance accept(Conclusion conclusion, Trials& trials, const std::vector<InverseDynamics>& inverse,
                  const Improver& improver, const LoadOptions& load, size_t catalogue,
                  const std::function<Conclusion(const Conclusion&, size_t)>& without) {
  Acceptance state;
  state.conclusion = std::move(conclusion);
  Judge judge(trials, inverse, improver, load);
  for (;;) {
    state.staircase = climb(trials, state.conclusion, inverse, catalogue);
    judge.run(state);
    const std::optional<Refusal> refusal = judge.refused(state);
    if (!state.why_not_run.empty()) state.runs.clear();
    if (!refusal) break;
    const Member& member = state.conclusion.estimate.members[refusal->member];
    const std::string name = shown_name(member, trials);
    state.refused.push_back({name, refusal->why, refusal->is_of_sensor, is_blurred(trials, member)});
    std::vector<std::string> trail = state.conclusion.trail;
    trail.push_back(name + ": " + refusal->why);
    state.conclusion = without(state.conclusion, refusal->member);
    std::ranges::move(state.conclusion.trail, std::back_inserter(trail));
    state.conclusion.trail = std::move(trail);
  }
  for (size_t i = 0; i < state.runs.size(); ++i)
    state.staircase.steps[i].simulation_rmse = state.runs[i].rmse();
  if (!has_own_load(state.conclusion.estimate.members)) need_what_simulates_better(state.staircase.steps);
  if (!state.runs.empty() && !has_own_load(state.staircase.members.back())) {
    state.is_worse = judge.is_worse_than_nominal(state);
    state.diverges = state.runs.back().diverged;
  }
  return state;
}

}  // namespace loopwright::diagnosis
