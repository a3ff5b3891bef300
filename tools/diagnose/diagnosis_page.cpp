#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "tools/diagnose/diagnosis_plots.h"
#include "tools/diagnose/wording.h"

namespace loopwright {
namespace {

bool is_first_of_its_name(const Diagnosis& d, size_t effect) {
  const auto first = std::ranges::find(d.effects, d.effects[effect].name, &DiagnosedEffect::name);
  return size_t(first - d.effects.begin()) == effect;
}

/// Each name once, strongest first: "cogging (7 of them)".
std::vector<std::string> effect_names(const Diagnosis& d) {
  std::vector<std::string> names;
  for (size_t i = 0; i < d.effects.size(); ++i) {
    if (!is_first_of_its_name(d, i)) continue;
    std::string name = words(d.effects[i].name);
    const auto times = std::ranges::count(d.effects, d.effects[i].name, &DiagnosedEffect::name);
    if (times > 1) name += fmt::format(" ({} of them)", times);
    for (const std::string& other : d.effects[i].alternatives) name += " (or " + words(other) + ")";
    names.push_back(name);
  }
  return names;
}

report::Notice verdict(const Diagnosis& d) {
  using Severity = report::Notice::Severity;
  const std::vector<std::string> names = effect_names(d);
  const std::string fall =
      fmt::format("The residual force falls from {} to {}; noise alone would leave {}.",
                  shown(d.error_before, d.force_unit), shown(d.error_after, d.force_unit),
                  shown(d.noise_floor, d.force_unit));
  std::string remainder = d.remainder_variables.empty()
                              ? ""
                              : " What is left depends on " + joined(d.remainder_variables, " and ") + ".";
  if (d.remainder_interval) remainder += " " + words_of_interval(d);
  switch (d.verdict) {
    case Verdict::nothing_missing:
      return {Severity::good, "Nothing is missing. The diagram explains the record down to its noise."};
    case Verdict::explained:
      return {Severity::good,
              "Missing: " + joined(names, ", ") + ". With that the record is explained. " + fall};
    case Verdict::partly_explained:
      return {Severity::warning, "Missing: " + joined(names, ", ") +
                                     ". Something else is left that the catalogue does not hold. " + fall +
                                     remainder};
    default:
      if (d.has_too_few_rows) return {Severity::warning, "Not judged: too few rows of the record count."};
      return {Severity::warning,
              "Something is missing that no effect of the catalogue explains." + remainder};
  }
}

/// The error against time, position or velocity, before and after.
report::Plot overlay(const Diagnosis& d, const char* title, const std::string& unit,
                     const std::vector<double>& x, const char* label, bool cloud) {
  report::Plot plot;
  plot.title = title;
  plot.x = {label, unit}, plot.y = {"Residual force", d.force_unit};
  const auto shape = cloud ? report::Series::Shape::points : report::Series::Shape::line;
  plot.series.push_back({"nominal diagram", x, d.curves.before, shape});
  if (!d.effects.empty()) plot.series.push_back({"with the effects found", x, d.curves.after, shape});
  return plot;
}

report::Section where_it_fails(const Diagnosis& d) {
  report::Section section{"Where the diagram fails", {}};
  section.items.push_back(report::Paragraph{
      "The force that the diagram leaves unexplained: net force of the diagram at the measured motion less "
      "mass times "
      "acceleration, filtered without delay. Gaps are rests, where dry friction may take any value."});
  if (!d.curves.time.empty())
    section.items.push_back(overlay(d, "Residual force over time", "s", d.curves.time, "Time", false));
  section.items.push_back(
      overlay(d, "Residual force over position", d.position_unit, d.curves.position, "Position", true));
  if (!d.curves.velocity.empty())
    section.items.push_back(overlay(d, "Residual force over velocity", d.position_unit + "/s",
                                    d.curves.velocity, "Velocity", true));
  return section;
}

std::string in_words(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " and ") + words(name);
  return text;
}

report::Section what_is_missing(const Diagnosis& d) {
  report::Section section{"What is missing", {}};
  if (d.effects.empty())
    section.items.push_back(report::Paragraph{"No effect of the catalogue is called for by this record."});
  for (size_t i = 0; i < d.effects.size(); ++i) {
    const DiagnosedEffect& effect = d.effects[i];
    std::string text = is_first_of_its_name(d, i) ? effect.title + ". " + effect.physics
                                                  : "Once more " + words(effect.name) + ".";
    text += fmt::format(" Its force is {} rms. Probability that it is there: {:.2f}.",
                        shown(effect.force_rms, d.force_unit), effect.inclusion);
    for (const std::string& other : effect.alternatives)
      text += fmt::format(" It might as well be {}: these two cannot be told apart by this record.",
                          words(other));
    section.items.push_back(report::Paragraph{std::move(text)});
    report::Table table{
        {"Parameter", "Value", "95 % interval", ""}, {}, "Parameters of " + words(effect.name) + "."};
    for (const DiagnosedParameter& p : told_parameters(effect)) {
      const ShownInterval told = shown_interval(p.value, p.low, p.high, p.unit);
      table.rows.push_back(
          {words(p.name), p.times_a_turn > 0 ? shown(p.value, p.unit) : told.value,
           p.times_a_turn > 0 ? fmt::format("{:.0f} times a turn", p.times_a_turn) : told.range(),
           p.at_limit ? "at the limit of its range: a warning, not a result" : ""});
    }
    section.items.push_back(std::move(table));
  }
  for (const OtherExplanation& other : d.other_explanations)
    section.items.push_back(
        report::Paragraph{fmt::format("In the place of {}, {} would explain the record as well.",
                                      in_words(other.in_place_of), in_words(other.effects))});
  return section;
}

/// A column after that of the fitted rows.
void add_held_out(const Diagnosis& d, report::Table& table) {
  constexpr ptrdiff_t behind_fitted = 2;
  table.head.insert(table.head.begin() + behind_fitted, "Residual force, held out");
  for (size_t i = 0; i < table.rows.size(); ++i)
    table.rows[i].insert(table.rows[i].begin() + behind_fitted,
                         i < d.steps.size() ? shown(d.steps[i].held_out_force_rmse, d.force_unit) : "");
  table.caption += " Held-out rows were never fitted.";
}

report::Section staircase(const Diagnosis& d) {
  report::Section section{"The staircase of the error", {}};
  report::Table table{
      {"Diagram", "Residual force, fitted",
       d.is_simulated() ? fmt::format("Simulated {:.3g} s ahead", d.simulation_horizon_s) : "", ""},
      {},
      "Each row has all parameters fitted anew."};
  for (const DiagnosisStep& step : d.steps) {
    std::vector<std::string> names;
    for (const std::string& name : step.added) names.push_back(words(name));
    table.rows.push_back({names.empty() ? "nominal" : "+ " + joined(names, " + "),
                          shown(step.force_rmse, d.force_unit),
                          d.is_simulated() ? shown(step.simulation_rmse, d.measured_unit) : "",
                          step.is_optional ? "optional: past the knee" : ""});
  }
  table.rows.push_back({"noise alone", shown(d.noise_floor, d.force_unit), "", ""});
  if (d.holds_out) add_held_out(d, table);
  if (d.steps.size() > 1) section.items.push_back(steps_of_the_error(d));
  section.items.push_back(std::move(table));
  return section;
}

report::Section what_remains(const Diagnosis& d) {
  report::Section section{"What remains", {}};
  report::KeyNumbers numbers{
      {{"Squared prediction error, fitted", fmt::format("{:.3f}", d.mean_square), "",
        "1 when all is explained"},
       {"Whiteness, 40 lags", fmt::format("{:.0f}", d.portmanteau), "", "near 40 when nothing is left"},
       {"White force noise", shown(d.white_force, d.force_unit), "", ""},
       {"Slow force noise", shown(d.slow_force, d.force_unit), "",
        fmt::format("over {:.3g} s", d.slow_force_time_s)}}};
  if (d.holds_out)
    numbers.numbers.insert(numbers.numbers.begin() + 1,
                           {"held out", fmt::format("{:.3f}", d.held_out_mean_square), "", ""});
  section.items.push_back(std::move(numbers));
  if (!d.whiteness.lag_s.empty()) section.items.push_back(whiteness(d));
  if (!d.dependence.empty()) {
    report::Table table{
        {"Variable", "Share of the remainder that it explains"}, {}, "On rows left out of the fit."};
    for (const RemainderShare& dependence : d.dependence)
      table.rows.push_back({words(dependence.variable), fmt::format("{:.0f} %", 100 * dependence.share)});
    section.items.push_back(std::move(table));
  }
  if (!d.remainder_variables.empty())
    section.items.push_back(report::Paragraph{
        "No effect of the catalogue has this dependence. A learned force (a Gpr block, trained by loopwright "
        "gp train) that reads " +
        joined(d.remainder_variables, " and ") + " can stand in for it until its cause is known."});
  return section;
}

report::Section what_next(const Diagnosis& d) {
  report::Section section{"What to measure next", {}};
  for (const SuggestedExperiment& e : d.suggested)
    section.items.push_back(report::Paragraph{
        fmt::format("To tell {} from {}: {}", words(e.between), words(e.and_effect), e.text)});
  for (const RecordFinding& f : d.findings)
    section.items.push_back(
        report::Notice{f.is_fatal ? report::Notice::Severity::error : report::Notice::Severity::warning,
                       fmt::format("The record: {}. What it costs: {}.", f.what, f.cost)});
  for (const std::string& why : d.contradictions)
    section.items.push_back(
        report::Notice{report::Notice::Severity::error, "The record is not explained: " + why + "."});
  for (const RefusedEffect& r : d.refused)
    section.items.push_back(report::Notice{report::Notice::Severity::warning,
                                           fmt::format("Not accepted: {}; {}.", words(r.effect), r.why)});
  if (!d.too_small.empty())
    section.items.push_back(
        report::Notice{report::Notice::Severity::note, words(words_of_small_effects(d)) + "."});
  for (const NotLookedFor& n : d.not_looked_for)
    section.items.push_back(
        report::Notice{report::Notice::Severity::warning,
                       fmt::format("Not looked for: {}; {}. If that is missing, it is not named.",
                                   words(joined(n.effects, ", ")), n.why)});
  if (section.items.empty())
    section.items.push_back(report::Paragraph{"Nothing: this record answers what was asked of it."});
  return section;
}

}  // namespace

report::Page diagnosis_page(const Diagnosis& d) {
  if (!d.has_roles) return any_diagram_page(d);
  report::Page page;
  page.title = d.title, page.subtitle = "Which physical effect is missing?";
  page.facts = {{"Diagram", d.diagram}, {"Records", joined(d.experiments, ", ")}};
  if (!d.improved.empty()) page.facts.emplace_back("Improved diagram", d.improved);
  page.sections.push_back({"Answer", {verdict(d)}});
  for (const MovedPort& moved : d.experiment_ports)
    page.sections.back().items.push_back(report::Notice{report::Notice::Severity::warning, words_of(moved)});
  page.sections.push_back(what_is_missing(d));
  if (!d.terms.empty()) page.sections.push_back(terms_at_their_sites(d));
  page.sections.push_back(staircase(d));
  page.sections.push_back(where_it_fails(d));
  page.sections.push_back(what_remains(d));
  if (!d.picture.nodes.empty()) page.sections.push_back(improved_diagram(d));
  page.sections.push_back(what_next(d));
  return page;
}

}  // namespace loopwright
