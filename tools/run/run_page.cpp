#include "tools/run/run_page.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "tools/draw/diagram_graph.h"

namespace loopwright {
namespace {

report::Table statistics(const Plan& plan, const RunResult& result) {
  const RunStatistics& s = result.statistics;
  report::Table table{{"Quantity", "Value"}, {}, "How the run was computed"};
  const auto row = [&](std::string name, std::string value) {
    table.rows.push_back({std::move(name), std::move(value)});
  };
  row("Method", std::string(to_name(plan.method)));
  row("Simulated time (s)", fmt::format("{:g}", result.time - plan.clock.time(plan.start_tick)));
  row("Computing time (s)", fmt::format("{:.3g}", s.wall_seconds));
  row("Steps", fmt::format("{}", s.steps));
  if (!is_fixed_step(plan.method)) {
    row("Rejected steps", fmt::format("{}", s.rejected_steps));
    row("Evaluations of the derivatives", fmt::format("{}", s.derivative_evaluations));
    row("Restarts after samples and events", fmt::format("{}", s.restarts));
  }
  row("Rows recorded", fmt::format("{}", s.rows));
  if (s.largest_pole > 0) row("Fastest pole at the start (rad/s)", fmt::format("{:.4g}", s.largest_pole));
  for (const CrossingCount& crossing : s.events)
    row("Events of " + crossing.name, fmt::format("{}", crossing.events));
  return table;
}

std::string progress_note(const Plan& plan, const RunResult& result) {
  return fmt::format("{} of {:g} s, {}", fmt::format("{:g}", result.time), plan.clock.time(plan.stop_tick),
                     to_name(plan.method));
}

void add_signals(report::Page& page, const std::vector<NamedRecording>& runs,
                 const std::function<bool(const std::string&)>& is_held) {
  report::Section signals{"Signals", {}};
  for (report::Plot& plot : scopes(runs, is_held)) signals.items.push_back(std::move(plot));
  signals.items.push_back(signal_table(runs));
  page.sections.push_back(std::move(signals));
  if (runs.size() > 1) page.sections.push_back(differences(runs));
  report::Section spectrum{"Spectra", {}};
  for (report::Plot& plot : spectra(runs)) spectrum.items.push_back(std::move(plot));
  if (!spectrum.items.empty()) page.sections.push_back(std::move(spectrum));
}

}  // namespace

report::Page run_page(const Diagram* diagram, const Plan& plan, const RunResult& result,
                      const RunFigures& figures, const std::vector<NamedRecording>& beside) {
  report::Page page;
  page.title = plan.title.empty() ? "A run" : plan.title;
  page.subtitle = fmt::format("Simulation, {}", progress_note(plan, result));
  page.facts = {{"Plan", plan.hash}, {"Seed", fmt::format("{}", plan.seed)}};
  report::Section outcome{"Outcome", {}};
  for (report::Notice& notice : verdict(plan, result, figures)) outcome.items.push_back(std::move(notice));
  if (report::KeyNumbers key = key_numbers(figures); !key.numbers.empty())
    outcome.items.push_back(std::move(key));
  for (const Problem& warning : plan.warnings)
    outcome.items.push_back(report::Notice{report::Notice::Severity::warning, to_string(warning)});
  for (const std::string& warning : result.warnings)
    outcome.items.push_back(report::Notice{report::Notice::Severity::warning, warning});
  page.sections.push_back(std::move(outcome));
  std::vector<NamedRecording> runs{{"this run", &result.recording}};
  runs.insert(runs.end(), beside.begin(), beside.end());
  add_signals(page, runs, [&](const std::string& signal) {
    const auto logged = std::ranges::find(plan.log, signal, &Plan::Logged::name);
    return logged != plan.log.end() && logged->rate.kind == Rate::Kind::sampled;
  });
  report::Table parameters{{"Parameter", "Value"}, {}, "Effective values, defaults included"};
  for (const auto& [name, value] : plan.parameters) parameters.rows.push_back({name, value});
  if (diagram) page.sections.push_back({"Diagram", {diagram_graph(*diagram, plan)}});
  page.sections.push_back({"Solver", {statistics(plan, result)}});
  page.sections.push_back({"Parameters", {std::move(parameters)}});
  return page;
}

report::Page recordings_page(const std::vector<NamedRecording>& recordings) {
  report::Page page;
  for (const NamedRecording& recording : recordings) {
    page.title += (page.title.empty() ? "" : ", ") + recording.name;
    page.facts.push_back({recording.name, fmt::format("{} rows", recording.recording->rows())});
  }
  page.subtitle = recordings.size() > 1 ? "Recordings laid over each other" : "A recording";
  add_signals(page, recordings, [](const std::string&) { return false; });
  return page;
}

std::string run_summary(const Plan& plan, const RunResult& result, const RunFigures& figures) {
  std::string text = fmt::format("{}: {} of {:g} s in {:.3g} s, {} steps of {}, {} rows\n",
                                 result.status == RunStatus::finished ? "done"
                                 : result.status == RunStatus::failed ? "failed"
                                                                      : "interrupted",
                                 fmt::format("{:g}", result.time), plan.clock.time(plan.stop_tick),
                                 result.statistics.wall_seconds, result.statistics.steps,
                                 to_name(plan.method), result.statistics.rows);
  text += figures_text(figures);
  size_t width = 6;
  for (const Column& column : result.recording.columns) width = std::max(width, column.name.size());
  text += fmt::format("  {:<{}}  {:>13} {:>13} {:>13}  unit\n", "signal", width, "least", "greatest", "last");
  for (size_t c = 1; c < result.recording.columns.size() && c <= 40; ++c) {
    const Column& column = result.recording.columns[c];
    if (column.values.empty()) continue;
    const SignalRange range(column.values);
    text += fmt::format("  {:<{}}  {:>13.6g} {:>13.6g} {:>13.6g}  {}{}\n", column.name, width, range.least,
                        range.greatest, range.last, column.unit,
                        range.not_finite ? fmt::format(", {} of {} rows without a number", range.not_finite,
                                                       column.values.size())
                                         : "");
  }
  if (result.recording.columns.size() > 41)
    text += fmt::format("  … and {} more\n", result.recording.columns.size() - 41);
  return text;
}

}  // namespace loopwright
