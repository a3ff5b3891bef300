#include <fmt/format.h>
#include <algorithm>
#include <nlohmann/json.hpp>
#include "tools/compare/compare.h"
#include "tools/report/typography.h"

namespace loopwright {
namespace {

using Json = nlohmann::ordered_json;

Json where_json(const ForceAnalysis& force) {
  Json list = Json::array();
  for (const ResidualShare& share : force.where) {
    Json entry = {{"axis", share.axis}};
    if (share.label.empty())
      entry["from"] = share.from, entry["to"] = share.to;
    else
      entry["from"] = share.label, entry["to"] = share.label;
    entry["share"] = share.share, entry["of_rows"] = share.of_rows;
    list.push_back(std::move(entry));
  }
  return list;
}

Json excitation_json(const ForceAnalysis& force) {
  const RecordContent& c = force.content;
  Json json = {
      {"directions", c.directions},     {"speeds", c.speeds},       {"accelerations", c.accelerations},
      {"reversals", c.reversals},       {"passes", c.passes},       {"varied_force", c.varied_force},
      {"duration_s", c.sizes.duration}, {"stroke", c.sizes.stroke}, {"top_speed", c.sizes.top_speed}};
  for (const Identifiability& entry : force.identifiable)
    json["effects"][entry.effect] = {{"can_be_found", entry.can_be_found}, {"lacks", entry.lacks}};
  return json;
}

void add_force(Json& json, const Comparison& comparison) {
  const ForceAnalysis& force = *comparison.force;
  const ForceResidual& r = force.residual;
  json["force_residual"] = {{"rmse", r.rmse},
                            {"relative_percent", r.relative_percent},
                            {"noise_floor", r.noise_floor},
                            {"noise_floor_from", r.floor_source},
                            {"unit", force.motion.force_unit}};
  json["where"] = where_json(force);
  for (const Dependence& d : force.dependence) {
    json["dependence"][d.variable] = d.share;
    if (d.share > 0 && d.at > 0) json["lines"][d.variable] = {{"period", 1 / d.at}, {"share", d.share}};
  }
  Json simulation = {{"open_loop_rmse", force.open_loop.whole_record}, {"unit", force.motion.position_unit}};
  for (const auto& [horizon, error] : force.open_loop.restarted)
    simulation["restarted"].push_back({{"horizon_s", horizon}, {"rmse", error}});
  json["simulation"] = std::move(simulation);
  json["excitation"] = excitation_json(force);
  json["faults"] = Json::array();
  for (const RecordFault& fault : force.faults)
    json["faults"].push_back({{"name", fault.name}, {"text", fault.text}, {"cost", fault.cost}});
}

std::string force_text(const Comparison& comparison) {
  const ForceAnalysis& f = *comparison.force;
  const std::string &force = f.motion.force_unit, &position = f.motion.position_unit;
  std::string text =
      fmt::format("\n  force that the model lacks: {} rms, {:.2f} % of the force; noise floor {} ({})\n",
                  report::shown(f.residual.rmse, force), f.residual.relative_percent,
                  report::shown(f.residual.noise_floor, force), f.residual.floor_source);
  std::vector<Dependence> ranked = f.dependence;
  std::ranges::stable_sort(ranked, std::greater{}, &Dependence::share);
  std::string depends;
  for (const Dependence& d : ranked) {
    if (d.share <= 0 || d.variable == "offset") continue;
    std::string name = d.variable;
    std::ranges::replace(name, '_', ' ');
    depends += fmt::format("{}{} {:.0f} %", depends.empty() ? "" : ", ", name, 100 * d.share);
    if (d.at > 0)
      depends += fmt::format(" (period {})", report::shown(1 / d.at, d.variable[0] == 's' ? position : "s"));
  }
  std::string constant;
  for (const Dependence& d : f.dependence)
    if (d.variable == "offset" && d.share >= 0.005)
      constant = fmt::format("a constant is {:.0f} % of it; the rest ", 100 * d.share);
  text += fmt::format("  {}depends on: {}\n", constant.empty() ? "it " : constant,
                      depends.empty() ? "nothing that this record shows" : depends);
  text += "  it lies in: ";
  for (const ResidualShare& s : f.where)
    if (s.axis == "segment" && s.of_rows > 0)
      text += fmt::format("{} {:.0f} % (of {:.0f} % of the time)  ", s.label, 100 * s.share, 100 * s.of_rows);
  text += fmt::format("\n  position, open loop: {} rms", report::shown(f.open_loop.whole_record, position));
  for (const auto& [horizon, error] : f.open_loop.restarted)
    text += fmt::format("; restarted every {:g} ms: {}", 1e3 * horizon, report::shown(error, position));
  text += "\n";
  std::string missing;
  for (const Identifiability& entry : f.identifiable)
    if (!entry.can_be_found) missing += fmt::format("    {}: needs {}\n", entry.effect, entry.lacks);
  if (!missing.empty()) text += "  this record cannot identify\n" + missing;
  for (const RecordFault& fault : f.faults)
    text += fmt::format("  the record: {}; {}\n", fault.text, fault.cost);
  return text;
}

}  // namespace

std::string to_json(const Comparison& comparison) {
  nlohmann::ordered_json json;
  json["plan"] = comparison.plan->hash;
  json["rows"] = comparison.time.size();
  if (comparison.missing_samples > 0) json["missing_samples"] = comparison.missing_samples;
  json["finished"] = comparison.run.status == RunStatus::finished;
  if (comparison.lacks_held_out) json["held_out_reached"] = false;
  if (!comparison.run.message.empty()) json["message"] = comparison.run.message;
  for (const ComparedSignal& s : comparison.signals) {
    auto& entry = json["signals"][s.name];
    entry = {{"rmse", s.rmse},
             {"max_abs", s.max_abs},
             {"mean", s.mean},
             {"relative_percent", s.relative_percent},
             {"fit_percent", s.fit_percent},
             {"unit", s.unit}};
    if (s.held_out_rmse > 0) entry["held_out_rmse"] = s.held_out_rmse;
  }
  json["closed_loop"] = comparison.is_closed_loop;
  if (comparison.force)
    add_force(json, comparison);
  else if (!comparison.why_no_force.empty())
    json["no_force_residual"] = comparison.why_no_force;
  return json.dump(2) + "\n";
}

namespace {

/// A line for each signal; a column for the rows that are held out, if there are any.
std::string signals_text(const Comparison& comparison) {
  size_t width = 6;
  for (const ComparedSignal& s : comparison.signals) width = std::max(width, s.name.size());
  const bool holds_out =
      std::ranges::any_of(comparison.signals, [](const auto& s) { return s.held_out_rmse > 0; });
  std::string text =
      fmt::format("  {:<{}} {:>12} {:>12} {:>12} {:>10} {:>9}{}\n", "signal", width, "error, rms", "greatest",
                  "mean", "relative", "fit", holds_out ? fmt::format(" {:>13}", "held out, rms") : "");
  for (const ComparedSignal& s : comparison.signals) {
    text += fmt::format("  {:<{}} {:>12} {:>12} {:>12} {:>8.2f} % {:>7.2f} %", s.name, width,
                        report::shown(s.rmse, s.unit), report::shown(s.max_abs, s.unit),
                        report::shown(s.mean, s.unit), s.relative_percent, s.fit_percent);
    text += (holds_out ? fmt::format(" {:>13}", report::shown(s.held_out_rmse, s.unit)) : "") + "\n";
  }
  if (comparison.lacks_held_out) text += fmt::format("  {}\n", no_held_out);
  return text;
}

}  // namespace

std::string to_text(const Comparison& comparison) {
  std::string text = signals_text(comparison);
  if (const int64_t missing = comparison.missing_samples; missing > 0)
    text += fmt::format("  {} sample{} between the {} rows of the recording {} missing\n", missing,
                        missing == 1 ? "" : "s", comparison.time.size(), missing == 1 ? "is" : "are");
  if (comparison.force)
    text += force_text(comparison);
  else if (!comparison.why_no_force.empty())
    text += fmt::format("  no residual force: {}\n", comparison.why_no_force);
  return text;
}

}  // namespace loopwright
