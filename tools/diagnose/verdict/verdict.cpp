#include "tools/diagnose/verdict/verdict.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace loopwright::diagnosis {

SuggestedExperiment separating_experiment(const Effect& effect, const std::string& other) {
  for (const ConfusableEffect& confusable : effect.confusable)
    if (confusable.with == other) return {confusable.experiment.text, effect.name, other};
  return {
      "Repeat the motion in both directions, at five speeds from very slow to fast, with a known mass on the "
      "axis.",
      effect.name, other};
}

namespace {

void add_variables(std::vector<std::string>& list, std::string_view joined) {
  for (size_t from = 0; from <= joined.size();) {
    const size_t comma = std::min(joined.find(',', from), joined.size());
    const std::string name(joined.substr(from, comma - from));
    if (std::ranges::find(list, name) == list.end()) list.push_back(name);
    from = comma + 1;
  }
}

}  // namespace

void judge(Trials& trials, const Conclusion& conclusion, const Motion& motion, const Noise& tight,
           Diagnosis& diagnosis) {
  const Estimate& e = conclusion.estimate;
  for (const Member& member : e.members)
    if (member.candidate->is_unknown) add_variables(diagnosis.remainder_variables, member.candidate->form);
  const bool has_unknown = !diagnosis.remainder_variables.empty();
  const bool is_not_white = !conclusion.is_white();
  if (is_not_white || has_unknown) {
    std::vector<Member> named;
    std::ranges::copy_if(e.members, std::back_inserter(named),
                         [](const Member& m) { return !m.candidate->is_unknown; });
    const Estimate seen = fit_members(trials, named, tight, motion, 0);
    diagnosis.dependence = dependence_of(trials, seen.fitted);
    if (!has_unknown && !diagnosis.dependence.empty() && diagnosis.dependence.front().share > 0.05)
      add_variables(diagnosis.remainder_variables, diagnosis.dependence.front().variable);
  }
  const bool is_fatal = std::ranges::any_of(diagnosis.findings, &RecordFinding::is_fatal);
  const bool leftover = is_not_white || has_unknown;
  if (diagnosis.effects.empty())
    diagnosis.verdict = leftover ? Verdict::unexplained : Verdict::nothing_missing;
  else
    diagnosis.verdict = leftover ? Verdict::partly_explained : Verdict::explained;
  if (!is_fatal) return;
  diagnosis.verdict = Verdict::unexplained;
}

}  // namespace loopwright::diagnosis
