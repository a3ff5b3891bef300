#include <fmt/format.h>
#include <cmath>
#include <filesystem>
#include "tools/draw/diagram_graph.h"
#include "tools/fit/fit.h"
#include "tools/report/typography.h"

namespace loopwright {
namespace {

using Severity = report::Notice::Severity;

std::string plain_unit(const std::string& unit) { return unit == "1" ? "" : unit; }

bool has_fitted_rows(const FittedSignal& s) { return s.before > 0 || s.after > 0 || s.held_out_before == 0; }

/// What the fit achieved, before any number.
std::vector<report::Notice> verdict(const Fit& fit) {
  std::vector<report::Notice> notices;
  if (fit.was_interrupted)
    notices.push_back({Severity::error, "The fit was interrupted: these are the best values until then."});
  else if (!fit.has_converged)
    notices.push_back(
        {Severity::error, "The fit did not settle: more iterations, or another start, may help."});
  else
    notices.push_back({Severity::good, "The fit settled."});
  for (const FittedSignal& s : fit.signals) {
    if (!has_fitted_rows(s)) continue;
    std::string text = fmt::format("{}: the error falls from {} to {} rms", s.name,
                                   report::shown(s.before, s.unit), report::shown(s.after, s.unit));
    if (!(s.after < s.before))
      text = fmt::format("{}: the error does not fall; it is {} rms, and was {}", s.name,
                         report::shown(s.after, s.unit), report::shown(s.before, s.unit));
    // Rows that the fit has not seen decide whether the values hold elsewhere.
    const bool is_worse_elsewhere = s.held_out_after > s.held_out_before;
    if (s.held_out_before > 0)
      text += fmt::format(". On held-out rows it {} from {} to {}", is_worse_elsewhere ? "rises" : "falls",
                          report::shown(s.held_out_before, s.unit), report::shown(s.held_out_after, s.unit));
    const bool is_bad = is_worse_elsewhere || !(s.after <= s.before);
    notices.push_back({is_bad ? Severity::warning : Severity::note, text + "."});
  }
  for (const std::string& warning : fit.warnings) notices.push_back({Severity::warning, warning + "."});
  return notices;
}

report::Table parameter_table(const std::vector<FittedParameter>& parameters, std::string caption) {
  report::Table table{
      {"Parameter", "Before", "Fitted", "Change (%)", "95 % interval, from", "to"}, {}, std::move(caption)};
  for (const FittedParameter& p : parameters) {
    const double change = 100 * (p.value - p.start) / std::abs(p.start);
    std::vector<std::string> row{p.path, report::shown(p.start, p.unit), report::shown(p.value, p.unit),
                                 std::isfinite(change) ? fmt::format("{:+.3g}", change) : "–"};
    if (p.is_determined)
      row.insert(row.end(), {report::shown(p.low, p.unit), report::shown(p.high, p.unit)});
    else
      row.push_back("not determined by these records");
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Section correlation_section(const FitCorrelations& correlations) {
  constexpr double close = 0.95;  // above it, the record hardly tells two parameters apart
  report::Section section{"Correlations", {}};
  report::Table table{
      {"Parameter"},
      {},
      "Correlation of the estimates: near 1 or −1, an error of one parameter is made up for by "
      "the other"};
  for (size_t k = 0; k < correlations.names.size(); ++k) table.head.push_back(fmt::format("{}", k + 1));
  for (size_t i = 0; i < correlations.names.size(); ++i) {
    std::vector<std::string> row{fmt::format("{} {}", i + 1, correlations.names[i])};
    for (size_t k = 0; k <= i; ++k) row.push_back(fmt::format("{:.2f}", correlations.of_each[i][k]));
    table.rows.push_back(std::move(row));
    for (size_t k = 0; k < i; ++k)
      if (std::abs(correlations.of_each[i][k]) > close)
        section.items.push_back(report::Notice{
            Severity::warning,
            fmt::format("\"{}\" and \"{}\" are hardly told apart: their correlation is {:.3f}.",
                        correlations.names[k], correlations.names[i], correlations.of_each[i][k])});
  }
  section.items.push_back(std::move(table));
  return section;
}

report::Section record_section(const std::string& title, const FittedRecord& record, const Comparison& before,
                               const Comparison& after) {
  report::Section section{title, {}};
  if (record.is_held_out)
    section.items.push_back(report::Notice{Severity::note, "This record was not fitted, only compared."});
  if (!record.parameters.empty())
    section.items.push_back(parameter_table(record.parameters, "Parameters of this record alone"));
  for (size_t s = 0; s < after.signals.size(); ++s) {
    const ComparedSignal &old = before.signals[s], &now = after.signals[s];
    report::Plot curves, errors;
    const std::vector<double> time = picked(now.rows, after.time),
                              time_before = picked(old.rows, before.time);
    curves.title = "Measured and simulated " + now.name;
    curves.x = errors.x = {"Time", "s", false};
    curves.y = {now.name, plain_unit(now.unit), false};
    curves.group = errors.group = title;
    curves.series = {{"measured", time, now.measured},
                     {"simulated before", time_before, old.simulated},
                     {"simulated after", time, now.simulated}};
    errors.title = "Error of " + now.name;
    errors.y = {"Error", plain_unit(now.unit), false};
    errors.caption = "Simulated minus measured";
    if (const FittedSignal& own = record.signals[s]; own.held_out_before > 0 && !record.is_held_out)
      errors.caption += fmt::format("; held-out rows at the end: {} rms before, {} after",
                                    report::shown(own.held_out_before, own.unit),
                                    report::shown(own.held_out_after, own.unit));
    errors.series = {{"before", time_before, old.error}, {"after", time, now.error}};
    for (report::Plot* plot : {&curves, &errors}) {
      for (report::Series& series : plot->series) series.x.resize(std::min(series.x.size(), series.y.size()));
      for (report::Series& series : plot->series) series.y.resize(series.x.size());
      section.items.push_back(std::move(*plot));
    }
  }
  return section;
}

}  // namespace

report::Page fit_page(const Fit& fit, const std::string& title) {
  report::Page page;
  page.title = title;
  page.subtitle = "Parameters fitted to measurements";
  page.facts = {{"Records", fmt::format("{}", fit.records.size())},
                {"Simulations", fmt::format("{}", fit.simulations)}};
  report::Section outcome{"Outcome", {}};
  for (report::Notice& notice : verdict(fit)) outcome.items.push_back(std::move(notice));
  report::KeyNumbers numbers;
  for (const FittedSignal& s : fit.signals) {
    if (!has_fitted_rows(s)) continue;
    const report::Quantity q = report::engineering(s.after, s.unit);
    numbers.numbers.push_back(
        {"Error of " + s.name + ", RMS", q.value, q.unit, "was " + report::shown(s.before, s.unit)});
  }
  outcome.items.push_back(std::move(numbers));
  page.sections.push_back(std::move(outcome));
  page.sections.push_back({"Parameters", {parameter_table(fit.parameters, "Before and after the fit")}});
  if (fit.correlations.names.size() > 1) page.sections.push_back(correlation_section(fit.correlations));
  for (size_t r = 0; r < fit.after.size(); ++r) {
    const std::string name = std::filesystem::path(fit.records[r].experiment).filename().string();
    page.sections.push_back(record_section(name, fit.records[r], fit.before[r], fit.after[r]));
  }
  if (!fit.after.empty() && fit.after[0].diagram && fit.after[0].plan)
    page.sections.push_back({"Diagram", {diagram_graph(*fit.after[0].diagram, *fit.after[0].plan)}});
  return page;
}

}  // namespace loopwright
