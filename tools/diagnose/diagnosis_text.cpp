#include <fmt/format.h>
#include <algorithm>
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/wording.h"

namespace loopwright {
namespace {

/// A force of position and velocity, which a Gpr block can learn.
bool can_be_learned(const Diagnosis& d) {
  return !d.remainder_variables.empty() &&
         std::ranges::all_of(d.remainder_variables, [](const std::string& v) {
           return v == "position" || v == "velocity" || v == "direction";
         });
}

}  // namespace

std::string words_of_improvement(const Diagnosis& d) {
  std::string text;
  for (const std::string& note : d.improved_notes) text += note + "\n";
  if (!d.taken_out_by.empty())
    text += fmt::format("Each of these takes one effect out of {} when 0: {}.\n", d.improved,
                        joined(d.taken_out_by, ", "));
  for (const MovedPort& moved : d.experiment_ports) text += words_of(moved) + "\n";
  if (!d.improved_experiments.empty())
    text += "Written with the new ports: " + joined(d.improved_experiments, ", ") + ".\n";
  return text;
}

std::vector<DiagnosedParameter> told_parameters(const DiagnosedEffect& effect) {
  if (effect.wave.empty()) return effect.parameters;
  std::vector<DiagnosedParameter> list = effect.wave;
  for (const DiagnosedParameter& p : effect.parameters)
    if (p.name != sine_name && p.name != cosine_name) list.push_back(p);
  return list;
}

std::string to_text(const Diagnosis& d) {
  if (!d.has_roles) return any_diagram_text(d);
  std::string text;
  const auto line = [&](const std::string& words) { text += words + "\n"; };
  switch (d.verdict) {
    case Verdict::nothing_missing:
      line("Nothing is missing: the diagram explains the record down to its noise.");
      break;
    case Verdict::explained:
      line("Missing, and with it the record is explained down to its noise:");
      break;
    case Verdict::partly_explained:
      line("Missing, but something is left that these effects do not explain:");
      break;
    case Verdict::unexplained:
      line(d.has_too_few_rows ? "Not judged: too few rows of the record count."
                              : "Something is missing that no effect of the catalogue explains.");
      break;
  }
  for (const DiagnosedEffect& effect : d.effects) {
    line(fmt::format("  {}{}  ({}, force {} rms, probability {:.2f}{})", effect.name,
                     effect.form.empty() ? "" : " of the " + effect.form, effect.title,
                     shown(effect.force_rms, d.force_unit), effect.inclusion,
                     effect.is_optional ? ", optional" : ""));
    for (const DiagnosedParameter& p : told_parameters(effect)) {
      const ShownInterval told = shown_interval(p.value, p.low, p.high, p.unit);
      if (p.times_a_turn > 0)
        line(fmt::format("    {} = {}  ({:.0f} times a turn)", p.name, shown(p.value, p.unit),
                         p.times_a_turn));
      else
        line(fmt::format("    {} = {}  ({}){}", p.name, told.value, told.range(),
                         p.at_limit ? "  at the limit of its range" : ""));
    }
    for (const std::string& other : effect.alternatives)
      line(fmt::format("    or {}: these two cannot be told apart by this record", other));
  }
  for (const OtherExplanation& other : d.other_explanations)
    line(fmt::format("  or {} in the place of {}: this record cannot tell", joined(other.effects, " + "),
                     joined(other.in_place_of, " + ")));
  if (!d.remainder_variables.empty())
    line("What is left depends on " + joined(d.remainder_variables, " and ") + ".");
  if (d.remainder_interval) line(words_of_interval(d));
  if (can_be_learned(d))
    line(
        "A Gpr block can stand in for it: train one on this record with `loopwright gp train`, with "
        "label.command, mass and damping.");
  const auto held_out = [&](const std::string& words) {
    return d.holds_out ? fmt::format(" {:>14}", words) : "";
  };
  line(fmt::format("  {:<42} {:>14}{} {:>14}", "residual force", "fitted", held_out("held out"),
                   d.is_simulated() ? fmt::format("{:.3g} s ahead", d.simulation_horizon_s) : ""));
  for (const DiagnosisStep& step : d.steps)
    line(fmt::format("  {:<42} {:>14}{} {:>14}{}",
                     step.added.empty() ? "nominal diagram" : "+ " + joined(step.added, " + "),
                     shown(step.force_rmse, d.force_unit),
                     held_out(shown(step.held_out_force_rmse, d.force_unit)),
                     d.is_simulated() ? shown(step.simulation_rmse, d.measured_unit) : "",
                     step.is_optional ? "  optional" : ""));
  line(fmt::format("  {:<42} {:>14}", "noise alone", shown(d.noise_floor, d.force_unit)));
  line(fmt::format("This rests on {} rows of the record in motion.", d.rows));
  for (const SuggestedExperiment& e : d.suggested)
    line(fmt::format("To tell {} from {}: {}", e.between, e.and_effect, e.text));
  for (const RecordFinding& f : d.findings) line(fmt::format("The record: {}; {}.", f.what, f.cost));
  for (const std::string& why : d.contradictions) line("Not explained: " + why + ".");
  for (const RefusedEffect& r : d.refused) line(fmt::format("Not accepted: {}; {}.", r.effect, r.why));
  if (!d.too_small.empty()) line(words_of_small_effects(d) + ".");
  for (const NotLookedFor& n : d.not_looked_for)
    line(fmt::format("Not looked for: {}; {}.", joined(n.effects, ", "), n.why));
  return text + words_of_improvement(d);
}

}  // namespace loopwright
