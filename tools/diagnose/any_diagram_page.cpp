/// The answer about any diagram as a page.
#include <fmt/format.h>
#include "tools/diagnose/diagnosis_plots.h"
#include "tools/diagnose/wording.h"

namespace loopwright {
namespace {

report::Notice notice_of(const Diagnosis& d) {
  using Severity = report::Notice::Severity;
  const std::string fall =
      fmt::format(" The error of {} one sample ahead falls from {} to {}; noise alone would leave {}.",
                  d.measured_port, shown(d.error_before, d.measured_unit),
                  shown(d.error_after, d.measured_unit), shown(d.noise_floor, d.measured_unit));
  switch (d.verdict) {
    case Verdict::nothing_missing:
      return {Severity::good, "Nothing is missing. The diagram explains the record down to its noise."};
    case Verdict::explained:
      return {Severity::good, "What was found explains the record." + fall};
    case Verdict::partly_explained:
      if (d.lacks_only_a_name)
        return {Severity::warning, "What was found explains the record, but a function has no name." + fall};
      return {Severity::warning, "What was found does not explain everything." + fall};
    default:
      return {Severity::warning, "Something is missing that cannot be named."};
  }
}

report::Section what_was_found(const Diagnosis& d) {
  report::Section section{"What was found", {}};
  if (d.effects.empty() && d.moved_parameters.empty())
    section.items.push_back(
        report::Paragraph{"No effect and no changed parameter is called for by this record."});
  for (const DiagnosedEffect& effect : d.effects) {
    std::string text = fmt::format("{}, at {}", effect.title, effect.site);
    if (!effect.variables.empty()) text += ", of " + joined(effect.variables, " and ");
    text += fmt::format(". Its size is {} rms.", shown(effect.force_rms, effect.site_unit));
    for (const std::string& other : effect.alternatives)
      text += fmt::format(" It might as well be {}: this record cannot tell.", other);
    section.items.push_back(report::Paragraph{std::move(text)});
    report::Table table{{"Parameter", "Value", "95 % interval"}, {}, "Parameters of " + effect.name + "."};
    for (const DiagnosedParameter& p : effect.parameters) {
      const ShownInterval shown_here = shown_interval(p.value, p.low, p.high, p.unit);
      table.rows.push_back({p.name, shown_here.value, shown_here.range()});
    }
    if (!table.rows.empty()) section.items.push_back(std::move(table));
  }
  if (!d.moved_parameters.empty()) {
    report::Table table{
        {"Parameter", "Stated", "Found", "95 % interval"}, {}, "Parameters of the diagram that moved."};
    for (const MovedParameter& p : d.moved_parameters) {
      const ShownInterval shown_here = shown_interval(p.value, p.low, p.high, p.unit);
      table.rows.push_back({p.name, shown(p.stated, p.unit), shown_here.value, shown_here.range()});
    }
    section.items.push_back(std::move(table));
  }
  for (const OtherExplanation& other : d.other_explanations)
    section.items.push_back(
        report::Paragraph{fmt::format("In the place of {}, {} would explain the record as well.",
                                      joined(other.in_place_of, " and "), words_of(other, " and "))});
  return section;
}

report::Section sites_staircase(const Diagnosis& d) {
  report::Section section{"The staircase of the error", {}};
  report::Table table{{"Diagram", "One sample ahead, fitted", "Simulated"},
                      {},
                      "The simulation begins anew ten times, over the held-out rows if there are any."};
  if (d.holds_out) table.head.insert(table.head.begin() + 2, "One sample ahead, held out");
  for (const DiagnosisStep& step : d.steps) {
    table.rows.push_back({step.added.empty() ? "as it is" : "+ " + joined(step.added, " + "),
                          shown(step.force_rmse, d.measured_unit),
                          shown(step.simulation_rmse, d.measured_unit)});
    if (d.holds_out)
      table.rows.back().insert(table.rows.back().begin() + 2,
                               shown(step.held_out_force_rmse, d.measured_unit));
  }
  if (d.steps.size() > 1) section.items.push_back(steps_of_the_error(d));
  section.items.push_back(std::move(table));
  return section;
}

report::Section what_is_left(const Diagnosis& d) {
  report::Section section{"What remains", {}};
  report::KeyNumbers numbers{
      {{"Squared prediction error, fitted", fmt::format("{:.3f}", d.mean_square), "",
        "1 when all is explained"},
       {"Whiteness, 40 lags", fmt::format("{:.0f}", d.portmanteau), "", "near 40 when nothing is left"}}};
  for (const SlowDisturbance& slow : d.slow_disturbances)
    numbers.numbers.push_back(
        {"Slow disturbance at " + slow.site, shown(slow.size, slow.unit), "",
         fmt::format("{:.1f} % of the signal, alike for {:.2g} s", 100 * slow.share, slow.time_s)});
  section.items.push_back(std::move(numbers));
  if (!d.whiteness.lag_s.empty()) section.items.push_back(whiteness(d));
  return section;
}

report::Section limits(const Diagnosis& d) {
  report::Section section{"What this record cannot tell", {}};
  for (const RecordFinding& f : d.findings)
    section.items.push_back(
        report::Notice{f.is_fatal ? report::Notice::Severity::error : report::Notice::Severity::warning,
                       fmt::format("The record: {}. What it costs: {}.", f.what, f.cost)});
  for (const std::string& sentence : d.not_observable)
    section.items.push_back(report::Paragraph{"Not told apart: " + sentence + "."});
  for (const NotLookedFor& n : d.not_looked_for)
    section.items.push_back(
        report::Notice{report::Notice::Severity::note,
                       fmt::format("Not looked for: {}; {}.", joined(n.effects, ", "), n.why)});
  if (section.items.empty())
    section.items.push_back(report::Paragraph{"All sites of the diagram can be told apart."});
  return section;
}

}  // namespace

report::Page any_diagram_page(const Diagnosis& d) {
  report::Page page;
  page.title = d.title, page.subtitle = "What does the diagram lack?";
  page.facts = {{"Diagram", d.diagram}, {"Record", joined(d.experiments, ", ")}};
  page.sections.push_back({"Answer", {notice_of(d)}});
  page.sections.push_back(what_was_found(d));
  if (!d.terms.empty()) page.sections.push_back(terms_at_their_sites(d));
  page.sections.push_back(sites_staircase(d));
  page.sections.push_back(what_is_left(d));
  if (!d.picture.nodes.empty()) page.sections.push_back(improved_diagram(d));
  page.sections.push_back(limits(d));
  return page;
}

}  // namespace loopwright
