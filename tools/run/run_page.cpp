#include "tools/run/run_page.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace loopwright {
namespace {

std::string unit_text(const Column& column) { return column.unit == "1" ? "" : column.unit; }

double peak_of(const Column& column) {
  double peak = 0;
  for (double v : column.values) peak = std::max(peak, std::abs(v));
  return peak;
}

/// A scope under construction: signals of one unit and of similar magnitude, so that agreement is visible and
/// a small error is not hidden by a large motion.
struct Scope {
  std::string unit;
  double peak;
  report::Plot plot;
  bool takes(const Column& column, double size) const {
    constexpr size_t most_signals = 6;
    constexpr double like = 30;
    return !unit.empty() && unit == column.unit && plot.series.size() < most_signals && size <= like * peak &&
           peak <= like * size;
  }
};

std::vector<report::Plot> scopes(const Plan& plan, const Recording& recording) {
  std::vector<Scope> scopes;
  for (size_t c = 1; c < recording.columns.size(); ++c) {
    const Column& column = recording.columns[c];
    const double peak = peak_of(column);
    auto scope = std::ranges::find_if(scopes, [&](const Scope& s) { return s.takes(column, peak); });
    if (scope == scopes.end()) {
      scopes.push_back({column.unit, peak, {}});
      scope = scopes.end() - 1;
      scope->plot.x = {"Time", "s", false};
      scope->plot.y = {column.name, unit_text(column), false};
      scope->plot.group = "time";
    }
    const bool held = plan.log[c - 1].rate.kind == Rate::Kind::sampled;
    scope->plot.series.push_back({column.name, recording.columns[0].values, column.values,
                                  held ? report::Series::Shape::steps : report::Series::Shape::line});
    if (scope->plot.series.size() > 1) scope->plot.y.label = "Signals";
  }
  std::vector<report::Plot> plots;
  for (Scope& scope : scopes) {
    for (const report::Series& series : scope.plot.series)
      scope.plot.caption += (scope.plot.caption.empty() ? "" : ", ") + series.name;
    scope.plot.caption += ".";
    plots.push_back(std::move(scope.plot));
  }
  return plots;
}

report::Table statistics(const Plan& plan, const RunResult& result) {
  const RunStatistics& s = result.statistics;
  report::Table table;
  table.head = {"Quantity", "Value"};
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

report::Table signal_table(const Recording& recording) {
  report::Table table;
  table.head = {"Signal", "Unit", "Least", "Greatest", "RMS", "Last"};
  for (size_t c = 1; c < recording.columns.size(); ++c) {
    const Column& column = recording.columns[c];
    if (column.values.empty()) continue;
    const auto [low, high] = std::ranges::minmax(column.values);
    double square = 0;
    for (double v : column.values) square += v * v;
    table.rows.push_back({column.name, unit_text(column), fmt::format("{:.6g}", low),
                          fmt::format("{:.6g}", high),
                          fmt::format("{:.6g}", std::sqrt(square / double(column.values.size()))),
                          fmt::format("{:.6g}", column.values.back())});
  }
  return table;
}

report::Notice ending(const Plan& plan, const RunResult& result) {
  using Severity = report::Notice::Severity;
  switch (result.status) {
    case RunStatus::finished:
      return {Severity::good,
              fmt::format("The run reached its stop time, {:g} s.", plan.clock.time(plan.stop_tick))};
    case RunStatus::interrupted:
      return {Severity::warning,
              "The run was " + result.message + "; what was computed until then is shown."};
    case RunStatus::failed:
      break;
  }
  return {Severity::error, "The run failed: " + result.message + ". What was computed until then is shown."};
}

}  // namespace

report::Graph graph_of(const Plan& plan) {
  report::Graph graph;
  for (const Plan::Block& block : plan.blocks) {
    report::GraphNode node{block.path, block.type->info.type, block.type->info.room, {}, {}};
    for (const PortInfo& port : block.type->info.inputs) node.inputs.emplace_back(port.name);
    for (const PortInfo& port : block.type->info.outputs) node.outputs.emplace_back(port.name);
    graph.nodes.push_back(std::move(node));
  }
  for (const Plan::Block& block : plan.blocks)
    for (size_t i = 0; i < block.inputs.size(); ++i) {
      std::pair<int, int> last{-1, -1};
      for (Number n : block.inputs[i]) {
        const auto source = plan.source_of(n);
        if (source.first < 0 || source == last) continue;
        last = source;
        const Plan::Block& from = plan.blocks[size_t(source.first)];
        const auto& unit = from.output_units[size_t(source.second)];
        graph.edges.push_back({from.path, std::string(from.type->info.outputs[size_t(source.second)].name),
                               block.path, std::string(block.type->info.inputs[i].name), "",
                               unit ? to_string(*unit) : ""});
      }
    }
  return graph;
}

report::Page run_page(const Plan& plan, const RunResult& result) {
  report::Page page;
  page.title = plan.title.empty() ? "A run" : plan.title;
  page.subtitle = "Simulation";
  page.facts = {{"Plan", plan.hash}, {"Seed", fmt::format("{}", plan.seed)}};
  report::Section outcome{"Outcome", {ending(plan, result)}};
  for (const Problem& warning : plan.warnings)
    outcome.items.push_back(report::Notice{report::Notice::Severity::warning, to_string(warning)});
  for (const std::string& warning : result.warnings)
    outcome.items.push_back(report::Notice{report::Notice::Severity::warning, warning});
  report::Section signals{"Signals", {}};
  for (report::Plot& plot : scopes(plan, result.recording)) signals.items.push_back(std::move(plot));
  signals.items.push_back(signal_table(result.recording));
  report::Section diagram{"Diagram", {}};
  for (report::Item& item : report::graph_picture(graph_of(plan))) diagram.items.push_back(std::move(item));
  report::Table parameters{{"Parameter", "Value"}, {}, "Effective values, defaults included."};
  for (const auto& [name, value] : plan.parameters) parameters.rows.push_back({name, value});
  page.sections = {std::move(outcome),
                   std::move(signals),
                   std::move(diagram),
                   {"Solver", {statistics(plan, result)}},
                   {"Parameters", {std::move(parameters)}}};
  return page;
}

std::string run_summary(const Plan& plan, const RunResult& result) {
  std::string text = fmt::format("{}: {} of {:g} s in {:.3g} s, {} steps of {}, {} rows\n",
                                 result.status == RunStatus::finished ? "done"
                                 : result.status == RunStatus::failed ? "failed"
                                                                      : "interrupted",
                                 fmt::format("{:g}", result.time), plan.clock.time(plan.stop_tick),
                                 result.statistics.wall_seconds, result.statistics.steps,
                                 to_name(plan.method), result.statistics.rows);
  size_t width = 6;
  for (const Column& column : result.recording.columns) width = std::max(width, column.name.size());
  text += fmt::format("  {:<{}}  {:>13} {:>13} {:>13}  unit\n", "signal", width, "least", "greatest", "last");
  for (size_t c = 1; c < result.recording.columns.size() && c <= 40; ++c) {
    const Column& column = result.recording.columns[c];
    if (column.values.empty()) continue;
    const auto [low, high] = std::ranges::minmax(column.values);
    text += fmt::format("  {:<{}}  {:>13.6g} {:>13.6g} {:>13.6g}  {}\n", column.name, width, low, high,
                        column.values.back(), column.unit);
  }
  if (result.recording.columns.size() > 41)
    text += fmt::format("  … and {} more\n", result.recording.columns.size() - 41);
  return text;
}

}  // namespace loopwright
