#include <fmt/format.h>
#include "tools/compare/compare.h"
#include "tools/draw/diagram_graph.h"
#include "tools/report/typography.h"

namespace loopwright {
namespace {

using report::Series;

/// Two decimals, but 100 only for 100: "99.998" must not look like a perfect fit.
std::string fit_text(double percent) {
  const std::string text = fmt::format("{:.2f}", percent);
  return text == "100.00" && percent < 100 ? "> 99.99" : text;
}

std::string shown_unit(const std::string& unit) { return unit == "1" ? "" : unit; }

report::Plot scatter(const ComparedSignal& s, std::string title, std::string axis, const std::string& unit,
                     const std::vector<double>& x) {
  report::Plot plot;
  plot.title = std::move(title);
  plot.x = {std::move(axis), shown_unit(unit), false};
  plot.y = {"Error of " + s.name, shown_unit(s.unit), false};
  plot.series.push_back({"simulated − measured", picked(s.rows, x), s.error, Series::Shape::points});
  Series& points = plot.series[0];
  points.x.resize(std::min(points.x.size(), points.y.size())), points.y.resize(points.x.size());
  return plot;
}

report::Plot overlay(const Comparison& c, const ComparedSignal& s) {
  report::Plot plot;
  plot.title = "Measured and simulated " + s.name;
  plot.x = {"Time", "s", false}, plot.y = {s.name, shown_unit(s.unit), false}, plot.group = "time";
  const std::vector<double> time = picked(s.rows, c.time);
  plot.series = {{"measured", time, s.measured, Series::Shape::line},
                 {"simulated", time, s.simulated, Series::Shape::line}};
  return plot;
}

/// What the comparison says about the model, before any number: whether it ran at all, and how far it is off.
std::vector<report::Notice> verdict(const Comparison& c) {
  using Severity = report::Notice::Severity;
  std::vector<report::Notice> notices;
  if (c.run.status != RunStatus::finished)
    notices.push_back(
        {Severity::error, "The simulation did not reach the end of the record: " + c.run.message});
  if (c.lacks_held_out) notices.push_back({Severity::warning, fmt::format("Held out: {}.", no_held_out)});
  for (const ComparedSignal& s : c.signals) {
    // Below half a step of the sensor nothing can be told from the model.
    const bool below_resolution = s.resolution > 0 && s.max_abs <= 0.5 * s.resolution;
    constexpr double poor = 50;  // % fit: a model half as good as none
    const Severity severity = below_resolution       ? Severity::good
                              : s.fit_percent < poor ? Severity::error
                                                     : Severity::note;
    notices.push_back(
        {severity,
         fmt::format(
             "{}: the model is off by {} rms and {} at most, {:.3g} % of the measured signal (rms){}.",
             s.name, report::shown(s.rmse, s.unit), report::shown(s.max_abs, s.unit), s.relative_percent,
             below_resolution       ? "; this is less than the sensor resolves"
             : s.fit_percent < poor ? "; it does not describe the record"
                                    : "")});
  }
  return notices;
}

report::Section signal_section(const Comparison& c, const ComparedSignal& s) {
  report::Section section{s.name, {}};
  report::KeyNumbers numbers;
  const auto number = [&](std::string label, double value) {
    const report::Quantity q = report::engineering(value, s.unit);
    return report::KeyNumbers::Number{std::move(label), q.value, q.unit, ""};
  };
  numbers.numbers = {number("Error, RMS", s.rmse),
                     number("Error, greatest", s.max_abs),
                     {"Relative to the signal", fmt::format("{:.2f}", s.relative_percent), "%", ""},
                     {"Fit", fit_text(s.fit_percent), "%", "100 (1 − ‖y − ŷ‖ / ‖y − mean y‖)"}};
  if (s.held_out_rmse > 0) numbers.numbers.push_back(number("Error, RMS, held out", s.held_out_rmse));
  section.items.push_back(std::move(numbers));
  report::Plot error;
  error.x = {"Time", "s", false}, error.y = {"Error", shown_unit(s.unit), false}, error.group = "time";
  error.series = {{"simulated − measured", picked(s.rows, c.time), s.error, Series::Shape::line}};
  if (s.resolution > 0)
    error.caption = fmt::format("The sensor resolves {}.", report::shown(s.resolution, s.unit));
  section.items.push_back(overlay(c, s));
  section.items.push_back(std::move(error));
  if (!c.position.empty())
    section.items.push_back(
        scatter(s, "Error against position", "Position, " + c.position_source, c.position_unit, c.position));
  if (!c.velocity.empty())
    section.items.push_back(
        scatter(s, "Error against velocity", "Velocity, " + c.velocity_source, c.velocity_unit, c.velocity));
  return section;
}

}  // namespace

report::Page comparison_page(const Comparison& c, const std::string& title) {
  report::Page page;
  page.title = title;
  page.subtitle = "The model held against the measurement";
  page.facts = {
      {"Diagram", c.plan->title}, {"Plan", c.plan->hash}, {"Rows", fmt::format("{}", c.time.size())}};
  if (c.missing_samples > 0) page.facts.push_back({"Missing samples", fmt::format("{}", c.missing_samples)});
  report::Table table{{"Signal", "Error, RMS", "Error, greatest", "Mean error", "Relative (%)", "Fit (%)"},
                      {},
                      "Simulated minus measured; fit is 100 (1 − ‖y − ŷ‖ / ‖y − mean y‖)"};
  for (const ComparedSignal& s : c.signals)
    table.rows.push_back({s.name, report::shown(s.rmse, s.unit), report::shown(s.max_abs, s.unit),
                          report::shown(s.mean, s.unit), fmt::format("{:.2f}", s.relative_percent),
                          fit_text(s.fit_percent)});
  report::Section summary{"Summary", {}};
  for (report::Notice& notice : verdict(c)) summary.items.push_back(std::move(notice));
  for (const std::string& warning : c.warnings)
    summary.items.push_back(report::Notice{report::Notice::Severity::warning, warning});
  if (!c.signals.empty()) summary.items.push_back(overlay(c, c.signals.front()));
  summary.items.push_back(std::move(table));
  page.sections.push_back(std::move(summary));
  for (const ComparedSignal& s : c.signals) page.sections.push_back(signal_section(c, s));
  for (report::Section& section : force_sections(c)) page.sections.push_back(std::move(section));
  page.sections.push_back({"Diagram", {diagram_graph(*c.diagram, *c.plan)}});
  return page;
}

}  // namespace loopwright
