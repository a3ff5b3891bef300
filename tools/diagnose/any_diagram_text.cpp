/// The answer about any diagram, in which no force is singled out, as text.
#include <fmt/format.h>
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/wording.h"

namespace loopwright {
namespace {

std::string verdict_of(const Diagnosis& d) {
  const bool are_parameters_only = d.effects.empty() && !d.moved_parameters.empty();
  switch (d.verdict) {
    case Verdict::nothing_missing:
      return "Nothing is missing: the diagram explains the record down to its noise.";
    case Verdict::explained:
      return are_parameters_only ? "No effect is missing, but parameters are not as stated. With them the "
                                   "record is explained:"
                                 : "Missing, and with it the record is explained down to its noise:";
    case Verdict::partly_explained:
      if (d.lacks_only_a_name)
        return "Found, and with it the record is explained down to its noise; a function has no name:";
      return "Found, but something is left that this does not explain:";
    default:
      return "Something is missing that cannot be named.";
  }
}

std::string with_interval(double value, double low, double high, const std::string& unit) {
  const ShownInterval text = shown_interval(value, low, high, unit);
  return fmt::format("{}  ({})", text.value, text.range());
}

}  // namespace

std::string any_diagram_text(const Diagnosis& d) {
  std::string text = verdict_of(d) + "\n";
  const auto line = [&](const std::string& words) { text += words + "\n"; };
  for (const DiagnosedEffect& effect : d.effects) {
    line(fmt::format("  {}{} at {}  ({}; {} rms{})", effect.name,
                     effect.variables.empty() ? "" : " of " + joined(effect.variables, ", "), effect.site,
                     effect.title, shown(effect.force_rms, effect.site_unit),
                     effect.is_optional ? ", optional" : ""));
    for (const DiagnosedParameter& p : effect.parameters)
      line(fmt::format("    {} = {}", p.name, with_interval(p.value, p.low, p.high, p.unit)));
    for (const std::string& other : effect.alternatives)
      line(fmt::format("    or {}: this record cannot tell", other));
  }
  for (const MovedParameter& p : d.moved_parameters)
    line(fmt::format("  {} = {}, not {}", p.name, with_interval(p.value, p.low, p.high, p.unit),
                     shown(p.stated, p.unit)));
  if (!d.moved_parameters.empty())
    line("  A parameter that is known for certain is kept by \"set\" of the experiment.");
  for (const OtherExplanation& other : d.other_explanations)
    line(fmt::format("  or {} in the place of {}: this record cannot tell", words_of(other, " + "),
                     other.in_place_of.empty() ? "none" : joined(other.in_place_of, " + ")));
  const auto held_out = [&](const std::string& words) {
    return d.holds_out ? fmt::format(" {:>14}", words) : "";
  };
  line(fmt::format("  {:<42} {:>14}{} {:>14}", "error of " + d.measured_port, "fitted", held_out("held out"),
                   "simulated"));
  for (const DiagnosisStep& step : d.steps)
    line(fmt::format("  {:<42} {:>14}{} {:>14}",
                     step.added.empty() ? "the diagram as it is" : "+ " + joined(step.added, " + "),
                     shown(step.force_rmse, d.measured_unit),
                     held_out(shown(step.held_out_force_rmse, d.measured_unit)),
                     shown(step.simulation_rmse, d.measured_unit)));
  line(fmt::format("This rests on {} rows of the record.", d.rows));
  for (const RecordFinding& f : d.findings) line(fmt::format("The record: {}; {}.", f.what, f.cost));
  for (const std::string& sentence : d.not_observable) line("Not told apart: " + sentence + ".");
  for (const NotLookedFor& n : d.not_looked_for)
    line(fmt::format("Not looked for: {}; {}.", joined(n.effects, ", "), n.why));
  return text + words_of_improvement(d);
}

}  // namespace loopwright
