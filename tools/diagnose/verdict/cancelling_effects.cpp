#include "tools/diagnose/verdict/cancelling_effects.h"
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/law_swaps.h"

namespace loopwright::diagnosis {
namespace {

/// [1] What the input keeps of its rms.
double left_of_input(const Trials& trials, const std::vector<Fitted>& fitted) {
  double recorded = 0, left = 0;
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const std::vector<double>& kept = fitted[t].prediction.path.input;  // of the fitted rows
    for (size_t k = 0; k < kept.size(); ++k)
      recorded += trials.list[t].input[k] * trials.list[t].input[k], left += kept[k] * kept[k];
  }
  return std::sqrt(left / recorded);
}

}  // namespace

std::string why_effects_cancel(const Diagnosis& diagnosis) {
  const double missing = diagnosis.steps.front().force_rmse;
  for (const DiagnosedEffect& effect : diagnosis.effects)
    if (diagnosis.effects.size() > 1 && effect.name != gain_name &&
        effect.force_rms > criteria::most_cancelled * missing)
      return fmt::format(
          "the effects cancel each other: the force of {} alone is {:.1f} times the force that is missing",
          effect.name, effect.force_rms / missing);
  return {};
}

std::string why_levels_cancel(const DiagnosedEffect& effect) {
  std::vector<std::string> names;
  for (const DiagnosedParameter& p : effect.parameters)
    if (p.unit == effect.site_unit && std::abs(p.value) > criteria::most_cancelled * effect.force_rms)
      names.push_back(p.name);
  if (names.size() < 2) return {};
  return fmt::format("{} of {} cancel each other: both are more than {:g} times what the law does",
                     fmt::join(names, " and "), effect.name, criteria::most_cancelled);
}

std::string why_input_is_taken_away(const Trials& trials, const Estimate& estimate) {
  double factor = 1;
  bool has_other_law = false, is_late = false;  // a lag takes noise of the input away
  for (const Member& member : estimate.members)
    if (member.candidate->name == gain_name)
      factor *= std::abs(1 + member.linear.front());
    else if (is_late_member(member))
      is_late = true;
    else
      has_other_law |= member.candidate->acts == Acts::input;
  const double left = left_of_input(trials, *estimate.fitted);
  const bool is_taken = left < criteria::least_input_left ||
                        (has_other_law && !is_late && left < criteria::least_input_left_by_law * factor);
  if (!is_taken) return {};
  return "what is named takes nearly all of the input away: see that sensor and drive were on, and that time "
         "and input have the units that are stated";
}

}  // namespace loopwright::diagnosis
