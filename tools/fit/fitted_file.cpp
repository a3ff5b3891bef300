#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include "engine/json/json.h"
#include "engine/json/reader.h"
#include "tools/effects/written_number.h"
#include "tools/fit/fit.h"
#include "tools/report/typography.h"

namespace loopwright {
namespace {

using Kind = Value::Kind;

nlohmann::ordered_json json_of(const std::vector<FittedParameter>& parameters,
                               const std::vector<FittedSignal>& signals) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const FittedParameter& p : parameters)
    json["parameters"][p.path] = {{"value", p.value}, {"low", p.low},   {"high", p.high},
                                  {"start", p.start}, {"unit", p.unit}, {"determined", p.is_determined}};
  for (const FittedSignal& s : signals) {
    json["signals"][s.name] = {{"rmse_before", s.before}, {"rmse_after", s.after}, {"unit", s.unit}};
    if (s.held_out_before > 0)
      json["signals"][s.name]["held_out_before"] = s.held_out_before,
      json["signals"][s.name]["held_out_after"] = s.held_out_after;
  }
  return json;
}

std::string lines_of(const std::vector<FittedParameter>& parameters, size_t width) {
  std::string text;
  for (const FittedParameter& p : parameters) {
    const std::string interval = std::isnan(p.low)   ? "–"
                                 : p.is_determined ? fmt::format("{:.5g} to {:.5g} {}", p.low, p.high, p.unit)
                                                   : "not determined by these records";
    text += fmt::format("  {:<{}} {:>12.6g} {:>12.6g}   {}\n", p.path, width, p.start, p.value, interval);
  }
  return text;
}

std::string lines_of(const std::vector<FittedSignal>& signals, size_t width) {
  const auto shown_error = [](double value, const std::string& unit) {
    const report::Quantity q = report::engineering(value, unit);
    return fmt::format("{} {}", q.value, q.unit);
  };
  std::string text;
  for (const FittedSignal& s : signals) {
    const bool has_fitted_rows = s.before > 0 || s.after > 0 || s.held_out_before == 0;
    text += fmt::format("  {:<{}} {:>12} {:>12}", s.name, width,
                        has_fitted_rows ? shown_error(s.before, s.unit) : "–",
                        has_fitted_rows ? shown_error(s.after, s.unit) : "–");
    if (s.held_out_before > 0)
      text += fmt::format("   held out: {} → {}", shown_error(s.held_out_before, s.unit),
                          shown_error(s.held_out_after, s.unit));
    text += "\n";
  }
  return text;
}

}  // namespace

std::string with_fitted_values(const std::string& path, const Fit& fit, Problems& problems) {
  const auto file = read_source(path, {}, problems);
  const Value root = file ? parse_json(file, problems) : Value{};
  if (problems.has_errors()) return "";
  TextEdits edits;
  for (const FittedParameter& p : fit.parameters) write_number(file, root, p.path, p.value, edits, problems);
  return problems.has_errors() ? "" : edits.apply(file->text);
}

std::string to_json(const Fit& fit) {
  nlohmann::ordered_json json;
  json["converged"] = fit.has_converged;
  json["simulations"] = fit.simulations;
  json.update(json_of(fit.parameters, fit.signals));
  for (const FittedRecord& record : fit.records) {
    if (fit.records.size() == 1 && record.parameters.empty()) continue;
    nlohmann::ordered_json own{{"experiment", record.experiment}, {"held_out", record.is_held_out}};
    own.update(json_of(record.parameters, record.signals));
    json["records"].push_back(std::move(own));
  }
  json["warnings"] = fit.warnings;
  return json.dump(2) + "\n";
}

std::string to_text(const Fit& fit) {
  size_t width = 9;
  for (const FittedParameter& p : fit.parameters) width = std::max(width, p.path.size());
  for (const FittedSignal& s : fit.signals) width = std::max(width, s.name.size());
  for (const FittedRecord& record : fit.records)
    for (const FittedParameter& p : record.parameters) width = std::max(width, p.path.size());
  std::string text =
      fmt::format("  {:<{}} {:>12} {:>12}   {}\n", "parameter", width, "before", "fitted", "95 % interval");
  text += lines_of(fit.parameters, width);
  text += fmt::format("  {:<{}} {:>12} {:>12}\n", "error, rms", width, "before", "fitted");
  text += lines_of(fit.signals, width);
  for (const FittedRecord& record : fit.records) {
    if (fit.records.size() == 1 && record.parameters.empty()) continue;
    text += fmt::format("  {}{}\n", record.experiment, record.is_held_out ? ", held out" : "");
    text += lines_of(record.parameters, width) + lines_of(record.signals, width);
  }
  for (const std::string& warning : fit.warnings) text += "  " + warning + "\n";
  if (!fit.has_converged && !fit.was_interrupted)
    text += "  the fit did not settle: more iterations, or another start, may help\n";
  return text;
}

}  // namespace loopwright
