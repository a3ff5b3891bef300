#include "tools/deploy/deployment_page.h"
#include <fmt/format.h>
#include <cmath>
#include <nlohmann/json.hpp>

namespace loopwright {
namespace {

using hw::Histogram;

std::string_view to_name(RunStatus status) {
  return status == RunStatus::finished      ? "finished"
         : status == RunStatus::interrupted ? "interrupted"
                                            : "failed";
}

struct NamedHistogram {
  const char* key;
  const char* title;
  const Histogram& histogram;
};
std::vector<NamedHistogram> histograms(const hw::LoopStatistics& s) {
  return {{"lateness", "Lateness of the sample", s.lateness},
          {"read", "Reading", s.read},
          {"step", "Step of the diagram", s.step},
          {"write", "Writing", s.write},
          {"total", "From sample to command", s.total}};
}

struct Count {
  const char* key;
  const char* title;
  nlohmann::ordered_json value;  // integer, or a number
};
std::vector<Count> counts(const hw::LoopStatistics& s) {
  return {{"cycles", "Cycles", s.cycles},
          {"overruns", "Commands that came too late", s.overruns},
          {"most_overruns_in_row", "Most of them in a row", s.most_overruns_in_row},
          {"longest_backlog", "Longest wait of a sample (periods)", s.longest_backlog},
          {"lost_samples", "Samples lost by the device", s.lost_samples},
          {"skipped_periods", "Periods skipped", s.skipped_periods},
          {"longest_gap", "Most instants in a row without a sample", s.longest_gap},
          {"glitches", "Readings of inputs that were held", s.glitches},
          {"clamped", "Values clamped", s.clamped},
          {"rate_limited", "Values limited in their rate", s.rate_limited},
          {"dropped_rows", "Rows of the log dropped", s.dropped_rows},
          {"log_delay_max_s", "Longest wait of a row for the log (s)", s.longest_log_delay_s},
          {"watchdog_min_margin_s", "Least margin to the watchdog (s)", s.least_watchdog_margin_s}};
}

report::Table table_of_times(const hw::LoopStatistics& s) {
  report::Table table;
  table.head = {"Time (us)", "mean", "median", "99 %", "99.9 %", "longest", "in cycle"};
  for (const auto& [key, title, h] : histograms(s))
    table.rows.push_back(
        {title, fmt::format("{:.2f}", h.mean_us()), fmt::format("{:.0f}", h.quantile_us(0.5)),
         fmt::format("{:.0f}", h.quantile_us(0.99)), fmt::format("{:.0f}", h.quantile_us(0.999)),
         fmt::format("{:.1f}", 1e-3 * double(h.longest_ns())), fmt::format("{}", h.longest_cycle())});
  table.caption = "Quantiles are ends of bins of one microsecond.";
  return table;
}

report::Plot histogram_plot(const hw::LoopStatistics& s) {
  report::Plot plot{"How long it took",        {"Time", "s", true}, {"Cycles", "", true}, {}, "",
                    "Bins of one microsecond."};
  for (const auto& [key, title, h] : histograms(s)) {
    report::Series series{title, {}, {}, report::Series::Shape::points};
    for (int us = 0; us < Histogram::bins; ++us)
      if (h.in_bin(us) > 0) series.x.push_back(1e-6 * (us + 0.5)), series.y.push_back(double(h.in_bin(us)));
    plot.series.push_back(std::move(series));
  }
  return plot;
}

/// Scopes: signals of one unit and of similar magnitude share a plot.
std::vector<report::Plot> scopes(const Recording& recording) {
  std::vector<report::Plot> plots;
  std::vector<double> peaks;
  for (size_t c = 1; c < recording.columns.size(); ++c) {
    const Column& column = recording.columns[c];
    double peak = 0;
    for (double v : column.values) peak = std::max(peak, std::abs(v));
    size_t p = 0;
    while (p < plots.size() &&
           !(plots[p].y.unit == column.unit && peak < 30 * peaks[p] && peaks[p] < 30 * peak))
      ++p;
    if (p == plots.size()) {
      plots.push_back({"", {"Time", "s", false}, {column.name, column.unit, false}, {}, "time", ""});
      peaks.push_back(peak);
    }
    plots[p].series.push_back(
        {column.name, recording.columns[0].values, column.values, report::Series::Shape::steps});
    if (plots[p].series.size() > 1) plots[p].y.label = "Signals";
  }
  return plots;
}

std::string_view explained(hw::OutputsSafe safe) {
  return safe == hw::OutputsSafe::untouched ? "untouched, as nothing was sent to the device" : to_name(safe);
}

report::Notice notice(const hw::DeployResult& result) {
  using Severity = report::Notice::Severity;
  const std::string safe = fmt::format("Outputs at their safe values: {}.", explained(result.outputs_safe));
  if (result.status == RunStatus::finished && result.outputs_safe == hw::OutputsSafe::confirmed)
    return {Severity::good, "Finished. " + safe};
  const bool is_bad = result.status == RunStatus::failed || result.outputs_safe == hw::OutputsSafe::unknown;
  return {is_bad ? Severity::error : Severity::warning, fmt::format("{}. {}", result.message, safe)};
}

}  // namespace

std::string to_json(const hw::DeployResult& result) {
  nlohmann::ordered_json json;
  json["status"] = to_name(result.status);
  json["message"] = result.message;
  json["outputs_safe"] = to_name(result.outputs_safe);
  json["time"] = result.time;
  for (const auto& [key, title, value] : counts(result.statistics)) json[key] = value;
  for (const auto& [key, title, h] : histograms(result.statistics))
    json[std::string(key) + "_us"] = {{"mean", h.mean_us()},
                                      {"p50", h.quantile_us(0.5)},
                                      {"p99", h.quantile_us(0.99)},
                                      {"p999", h.quantile_us(0.999)},
                                      {"max", 1e-3 * double(h.longest_ns())},
                                      {"max_cycle", h.longest_cycle()}};
  json["blocks"] = nlohmann::ordered_json::array();
  for (const hw::BlockTime& block : result.statistics.blocks)
    json["blocks"].push_back(
        {{"path", block.path}, {"mean_us", block.mean_us}, {"max_us", block.longest_us}});
  json["system"] = nlohmann::ordered_json::array();
  for (const hw::Granted& item : result.system.items)
    json["system"].push_back({{"what", item.what}, {"granted", item.is_granted}, {"answer", item.answer}});
  json["device"] = result.device;
  return json.dump(2) + "\n";
}

std::string to_text(const hw::DeployResult& result) {
  const hw::LoopStatistics& s = result.statistics;
  std::string text = fmt::format("{} cycles, {} too late, {} samples lost, {} rows of the log dropped\n",
                                 s.cycles, s.overruns, s.lost_samples, s.dropped_rows);
  for (const auto& [key, title, h] : histograms(s))
    text +=
        fmt::format("  {:<24} mean {:7.2f} us   99 % {:5.0f} us   longest {:8.1f} us in cycle {}\n", title,
                    h.mean_us(), h.quantile_us(0.99), 1e-3 * double(h.longest_ns()), h.longest_cycle());
  if (s.skipped_periods > 0)
    text += fmt::format("  {} periods skipped by this computer\n", s.skipped_periods);
  if (s.longest_gap > 0)
    text += fmt::format("  at most {} instants in a row without a sample\n", s.longest_gap);
  if (s.clamped + s.rate_limited + s.glitches > 0)
    text += fmt::format("  {} values clamped, {} limited in their rate, {} readings held\n", s.clamped,
                        s.rate_limited, s.glitches);
  if (s.least_watchdog_margin_s != 0)
    text += fmt::format("  least margin to the watchdog {:.2f} ms\n", 1e3 * s.least_watchdog_margin_s);
  return text + fmt::format("outputs safe: {}\n", explained(result.outputs_safe));
}

report::Page deployment_page(const Plan& plan, const hw::DeployResult& result) {
  report::Page page;
  page.title = plan.title.empty() ? "Deployment" : plan.title;
  page.subtitle = "On hardware";
  page.facts = {{"Plan", plan.hash}, {"Time", fmt::format("{:g} s", result.time)}};
  const hw::LoopStatistics& s = result.statistics;
  const auto us = [](double value) { return fmt::format("{:.0f}", value); };
  report::KeyNumbers numbers{{{"Cycles", fmt::format("{}", s.cycles), "", ""},
                              {"Too late", fmt::format("{}", s.overruns), "", ""},
                              {"Lateness, longest", us(1e-3 * double(s.lateness.longest_ns())), "us", ""},
                              {"Step, 99 %", us(s.step.quantile_us(0.99)), "us", ""},
                              {"Outputs safe", std::string(explained(result.outputs_safe)), "", ""}}};
  page.sections.push_back({"Outcome", {notice(result), numbers}});
  report::Section signals{"Signals", {}};
  for (report::Plot& plot : scopes(result.recording)) signals.items.push_back(std::move(plot));
  page.sections.push_back(std::move(signals));
  report::Table accounts{{"Account", "Value"}, {}, "What was counted during the deployment."};
  for (const auto& [key, title, value] : counts(s)) accounts.rows.push_back({title, value.dump()});
  report::Table blocks{
      {"Block", "mean (µs)", "longest (µs)"}, {}, "Time of each block in a sample, slowest first."};
  for (const hw::BlockTime& block : s.blocks)
    blocks.rows.push_back(
        {block.path, fmt::format("{:.3f}", block.mean_us), fmt::format("{:.2f}", block.longest_us)});
  page.sections.push_back({"Timing", {histogram_plot(s), table_of_times(s), accounts, blocks}});
  report::Table system{
      {"Asked of the system", "Granted", "Answer"}, {}, "What the operating system granted to the loop."};
  for (const hw::Granted& item : result.system.items)
    system.rows.push_back({item.what, item.is_granted ? "yes" : "no", item.answer});
  report::Paragraph device;
  for (const std::string& line : result.device) device.text += line + "\n\n";
  page.sections.push_back({"Device and system", {device, system}});
  return page;
}

}  // namespace loopwright
