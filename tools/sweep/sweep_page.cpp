#include "tools/sweep/sweep_page.h"
#include <filesystem>
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include "tools/report/typography.h"
#include "tools/sweep/robustness.h"
#include "tools/sweep/sensitivity.h"
#include "tools/sweep/sweep_pictures.h"
#include "models/statistics/quantile.h"

namespace loopwright {
namespace {

constexpr size_t worst_shown = 5;

const std::vector<double>& metric_column(const SweepPlan& plan, const Recording& table, size_t metric) {
  return table.columns[1 + plan.sweep().axes.size() + metric].values;
}
const std::string& unit_of(const SweepPlan& plan, size_t metric) {
  return plan.world(0).observed.units[metric];
}

std::vector<double> sorted_finite(const std::vector<double>& values) {
  std::vector<double> finite;
  for (const double v : values)
    if (std::isfinite(v)) finite.push_back(v);
  std::sort(finite.begin(), finite.end());
  return finite;
}
std::string readable(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "—"; }

bool is_within(const Metric& metric, double value) { return value >= metric.least && value <= metric.most; }

std::string shown(const Axis& axis, double value) {
  return axis.kind == Axis::Kind::variants ? axis.variants[size_t(value)] : fmt::format("{:.5g}", value);
}

/// The first axis of variants, if there is one: it distinguishes the runs.
std::optional<size_t> axis_of_variants(const Sweep& sweep) {
  for (size_t a = 0; a < sweep.axes.size(); ++a)
    if (sweep.axes[a].kind == Axis::Kind::variants) return a;
  return {};
}

report::Table metrics_table(const SweepPlan& plan, const Recording& table) {
  report::Table shown_table;
  shown_table.head = {"Metric", "Unit",   "Runs", "Mean",     "Least",
                      "5 %",    "Median", "95 %", "Greatest", "Within limits"};
  for (size_t m = 0; m < plan.sweep().metrics.size(); ++m) {
    const Metric& metric = plan.sweep().metrics[m];
    const auto values = sorted_finite(metric_column(plan, table, m));
    double sum = 0;
    int64_t within = 0;
    for (const double v : values) sum += v, within += is_within(metric, v);
    const bool is_limited = std::isfinite(metric.least) || std::isfinite(metric.most);
    shown_table.rows.push_back(
        {metric.name, report::readable_unit(unit_of(plan, m)), fmt::format("{}", values.size()),
         readable(values.empty() ? std::nan("") : sum / double(values.size())), readable(quantile(values, 0)),
         readable(quantile(values, 0.05)), readable(quantile(values, 0.5)), readable(quantile(values, 0.95)),
         readable(quantile(values, 1)),
         is_limited
             ? fmt::format("{:.2f} %", 100.0 * double(within) / double(std::max<size_t>(1, table.rows())))
             : ""});
  }
  shown_table.caption =
      "Runs that failed, or whose metric is no number, are left out of the statistics; they are outside of "
      "limits.";
  return shown_table;
}

/// Cumulative distribution of a metric, one curve per variant.
report::Plot distribution(const SweepPlan& plan, const Recording& table, size_t metric) {
  report::Plot plot;
  const auto& axes = plan.sweep().axes;
  const auto by = axis_of_variants(plan.sweep());
  std::map<int, std::vector<double>> groups;
  const auto& values = metric_column(plan, table, metric);
  for (size_t row = 0; row < values.size(); ++row)
    groups[by ? int(table.columns[1 + *by].values[row]) : 0].push_back(values[row]);
  for (const auto& [variant, all] : groups) {
    const auto sorted = sorted_finite(all);
    report::Series series;
    series.name = by ? axes[*by].variants[size_t(variant)] : "all runs";
    series.shape = report::Series::Shape::steps;
    const size_t stride = std::max<size_t>(1, sorted.size() / 2000);
    for (size_t i = 0; i < sorted.size(); i += stride) {
      series.x.push_back(sorted[i]);
      series.y.push_back(100.0 * double(i + 1) / double(all.size()));
    }
    plot.series.push_back(std::move(series));
  }
  plot.title = plan.sweep().metrics[metric].name;
  plot.x = {plan.sweep().metrics[metric].name, unit_of(plan, metric), false};
  plot.y = {"Share of runs at or below", "%", false};
  plot.caption = !by ? ""
                     : fmt::format(
                           "A curve for each variant of {}: the further left, the better for a "
                           "metric that should be small.",
                           axes[*by].name);
  return plot;
}

/// Means along each axis, from its smallest (0) to its largest value (1).
report::Plot main_effects(const SweepPlan& plan, const std::vector<AxisEffect>& effects, size_t metric) {
  report::Plot plot;
  plot.title = "Main effects on " + plan.sweep().metrics[metric].name;
  plot.x = {"Place on the axis, from least to greatest value", "", false};
  plot.y = {"Mean of " + plan.sweep().metrics[metric].name, unit_of(plan, metric), false};
  for (const AxisEffect& effect : effects) {
    if (effect.bins.size() < 2) continue;
    report::Series series;
    series.name = effect.axis;
    const double low = effect.bins.front().from, high = effect.bins.back().to;
    for (const Bin& bin : effect.bins) {
      series.x.push_back(high > low ? (0.5 * (bin.from + bin.to) - low) / (high - low) : 0);
      series.y.push_back(bin.mean);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

/// An index with twice its standard error, or only a bound if the estimate is not above that.
std::string index_text(double index, double error) {
  const double margin = 2 * error;
  if (index <= margin) return fmt::format("< {:.3f}", std::max(margin, 0.001));
  return margin < 0.0005 ? fmt::format("{:.3f}", index) : fmt::format("{:.3f} ± {:.3f}", index, margin);
}

report::Table indices(const SweepPlan& plan, const std::vector<AxisEffect>& effects, size_t metric) {
  report::Table table;
  table.head = {"Axis", "First-order index", "Total index", "Mean at the least value", "at the greatest"};
  for (const AxisEffect& effect : effects) {
    // What an axis explains by itself is part of what it explains in all: an estimate beyond that is noise.
    const double first = effect.total ? std::min(effect.first_order, *effect.total) : effect.first_order;
    const double error = effect.total ? std::max(effect.first_order_error, effect.first_order - first)
                                      : effect.first_order_error;
    table.rows.push_back({effect.axis, index_text(first, error),
                          effect.total ? index_text(*effect.total, effect.total_error) : "",
                          readable(effect.bins.empty() ? std::nan("") : effect.bins.front().mean),
                          readable(effect.bins.empty() ? std::nan("") : effect.bins.back().mean)});
  }
  table.caption = fmt::format(
      "Share of the variance of {} that each axis explains by itself, and with all interactions{}; ± is "
      "twice the standard error of the estimate.",
      plan.sweep().metrics[metric].name,
      plan.sweep().samples.method == Sampling::saltelli ? ""
                                                        : " (total indices need the sampling \"saltelli\")");
  return table;
}

report::Section robustness(const SweepPlan& plan, const Recording& table, size_t by) {
  report::Section section{"Which is robust to what", {}};
  section.items.push_back(robustness_picture(plan, table, 0, by));
  for (size_t m = 0; m < plan.sweep().metrics.size(); ++m)
    section.items.push_back(robustness_table(plan, table, m, by));
  return section;
}

report::Section worst_cases(const SweepPlan& plan, const Recording& table, const TracePages& traces) {
  report::Section section{"Worst cases", {}};
  const auto& axes = plan.sweep().axes;
  for (size_t m = 0; m < plan.sweep().metrics.size(); ++m) {
    report::Table rows;
    rows.head = {"Run", plan.sweep().metrics[m].name};
    for (const Axis& axis : axes) rows.head.push_back(report::with_unit(axis.name, axis.unit));
    std::string commands;
    const auto worst = worst_rows(plan, table, m, worst_shown);
    section.items.push_back(worst_in_distribution(plan, table, m, worst, traces));
    for (const size_t row : worst) {
      const int64_t run = int64_t(table.columns[0].values[row]);
      std::vector<std::string> cells{fmt::format("{}", run), readable(metric_column(plan, table, m)[row])};
      for (size_t a = 0; a < axes.size(); ++a)
        cells.push_back(shown(axes[a], table.columns[1 + a].values[row]));
      rows.rows.push_back(std::move(cells));
      commands += plan.command(run) + "\n";
    }
    rows.caption = report::with_unit("By " + plan.sweep().metrics[m].name, unit_of(plan, m)) + ".";
    section.items.push_back(std::move(rows));
    section.items.push_back(
        report::Code{commands, "Each run again, bit for bit; add --report page.html to look at it"});
  }
  return section;
}

report::Section failures(const SweepPlan& plan, const SweepResults& results) {
  report::Section section{"Failed runs", {}};
  std::map<std::string, std::pair<int64_t, int64_t>> kinds;  // reason without its time → count, first run
  for (const auto& [run, reason] : results.failures) {
    const size_t at = reason.find(" at t = "), end = reason.find(" s", at);
    const std::string kind =
        at == reason.npos || end == reason.npos ? reason : reason.substr(0, at) + reason.substr(end + 2);
    auto& [count, first] = kinds[kind];
    if (count++ == 0) first = run;
  }
  report::Table table;
  table.head = {"Runs", "Reason", "First"};
  std::string commands;
  for (const auto& [reason, entry] : kinds) {
    table.rows.push_back({fmt::format("{}", entry.first), reason, fmt::format("{}", entry.second)});
    if (table.rows.size() <= worst_shown) commands += plan.command(entry.second) + "\n";
  }
  section.items.push_back(std::move(table));
  section.items.push_back(report::Code{commands, "The first of each again"});
  return section;
}

}  // namespace

std::vector<size_t> worst_rows(const SweepPlan& plan, const Recording& table, size_t metric, size_t most) {
  const Metric& m = plan.sweep().metrics[metric];
  const bool least_is_worst = std::isfinite(m.least) && !std::isfinite(m.most);
  const auto& values = metric_column(plan, table, metric);
  std::vector<size_t> rows;
  for (size_t row = 0; row < values.size(); ++row)
    if (std::isfinite(values[row])) rows.push_back(row);
  most = std::min(most, rows.size());
  std::partial_sort(rows.begin(), rows.begin() + ptrdiff_t(most), rows.end(), [&](size_t a, size_t b) {
    if (values[a] != values[b]) return least_is_worst ? values[a] < values[b] : values[a] > values[b];
    return a < b;
  });
  rows.resize(most);
  return rows;
}

std::vector<int64_t> runs_to_keep(const SweepPlan& plan, const SweepResults& results) {
  const Keep& keep = plan.sweep().keep;
  std::vector<int64_t> runs;
  if (keep.kind == Keep::Kind::selected)
    for (const int64_t run : keep.runs)
      if (run < plan.runs()) runs.push_back(run);
  if (keep.kind == Keep::Kind::all)
    for (const double run : results.table.columns[0].values) runs.push_back(int64_t(run));
  if (keep.kind == Keep::Kind::failed)
    for (const auto& [run, reason] : results.failures) runs.push_back(run);
  if (keep.kind == Keep::Kind::worst)
    for (size_t m = 0; m < plan.sweep().metrics.size(); ++m)
      if (plan.sweep().metrics[m].name == keep.metric)
        for (const size_t row : worst_rows(plan, results.table, m, size_t(keep.count)))
          runs.push_back(int64_t(results.table.columns[0].values[row]));
  return runs;
}

report::Page sweep_page(const SweepPlan& plan, const SweepResults& results, const TracePages& traces) {
  const Sweep& sweep = plan.sweep();
  const Recording& table = results.table;
  report::Page page;
  page.title = sweep.title.empty() ? "Sweep" : sweep.title;
  page.facts = {
      {"Sweep", std::filesystem::path(sweep.path).filename().string()},
      {"Diagram", std::filesystem::path(sweep.diagram).filename().string()},
      {"Runs", fmt::format("{} of {}", report::grouped(table.rows()), report::grouped(size_t(plan.runs())))},
      {"Failed", report::grouped(results.failures.size())},
      {"Results", plan.hash()}};
  report::Section overview{"Metrics", {metrics_table(plan, table)}};
  if (results.missing)
    overview.items.insert(overview.items.begin(),
                          report::Notice{report::Notice::Severity::warning,
                                         fmt::format("{} runs have no result yet.", results.missing)});
  page.sections.push_back(std::move(overview));
  if (const auto by = axis_of_variants(sweep); by && sweep.axes.size() > 1)
    page.sections.push_back(robustness(plan, table, *by));
  report::Section spread{"Distributions", {}}, sensitivity{"What matters", {}};
  for (size_t m = 0; m < sweep.metrics.size(); ++m) {
    spread.items.push_back(distribution(plan, table, m));
    const auto effects = effects_of(plan, table, m);
    sensitivity.items.push_back(main_effects(plan, effects, m));
    sensitivity.items.push_back(indices(plan, effects, m));
    if (sweep.axes.size() > 1) sensitivity.items.push_back(heat_map(plan, table, m, effects));
  }
  page.sections.push_back(std::move(spread));
  page.sections.push_back(std::move(sensitivity));
  page.sections.push_back({"All axes at a glance", {parallel_coordinates(plan, table, 0)}});
  page.sections.push_back(worst_cases(plan, table, traces));
  if (!results.failures.empty()) page.sections.push_back(failures(plan, results));
  return page;
}

}  // namespace loopwright
