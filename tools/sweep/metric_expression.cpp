#include "tools/sweep/metric_expression.h"
#include <fmt/format.h>
#include <algorithm>
#include <numbers>
#include "engine/unit/rescaling.h"

namespace loopwright {
namespace {

UnitFinding find_unit_of(const Metric& metric, const std::vector<std::string>& ports,
                         const std::vector<Quantity>& arguments, Unit& unit) {
  double half_turn = std::numbers::pi;
  std::vector<double> values(ports.size(), 1.0);
  FormulaParser parser = metric_parser(&half_turn);
  for (size_t i = 0; i < ports.size(); ++i) parser.DefineVar(ports[i], &values[i]);
  const auto at = [&](const std::vector<double>& numbers, double pi) {
    std::ranges::copy(numbers, values.begin());
    half_turn = pi;
    return parser.Eval();
  };
  try {
    parser.set_formula(metric.signal.substr(1));
    return find_unit(at, arguments, unit);
  } catch (const mu::ParserError&) {  // reported by ports_of, or when the metric is prepared
    return UnitFinding::no_result;
  }
}

}  // namespace

FormulaParser metric_parser(double* half_turn) {
  FormulaParser parser;
  parser.DefineNameChars("0123456789_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.[]");
  if (half_turn)
    parser.DefineVar("pi", half_turn);
  else
    parser.DefineConst("pi", std::numbers::pi);
  parser.DefineConst("e", std::numbers::e);
  return parser;
}

std::vector<std::string> ports_of(const Metric& metric, Problems& problems) {
  if (!is_expression(metric.signal)) return {metric.signal};
  try {
    FormulaParser parser = metric_parser();
    parser.set_formula(metric.signal.substr(1));
    std::vector<std::string> ports;
    for (const auto& [name, value] : parser.GetUsedVar()) ports.push_back(name);
    return ports;
  } catch (const mu::ParserError& error) {
    problems.error(metric.place, metric.pointer, "", "the expression cannot be read").found =
        FormulaParser::message_of(error);
    return {};
  }
}

std::optional<Unit> unit_of_expression(const Metric& metric, const std::vector<std::string>& ports,
                                       const std::vector<std::optional<Unit>>& units, Problems& problems) {
  std::vector<Quantity> arguments;
  for (const auto& unit : units)
    if (unit) arguments.push_back({1.0, *unit});
  if (ports.empty() || arguments.size() != ports.size()) return {};
  Unit unit;
  const UnitFinding finding = find_unit_of(metric, ports, arguments, unit);
  const bool is_turns_over_hertz = finding == UnitFinding::known && unit.cycles() == -2;
  if (finding == UnitFinding::known && !is_turns_over_hertz) return unit;
  if (finding == UnitFinding::zero || finding == UnitFinding::no_result) return {};
  auto& p = problems.error(metric.place, metric.pointer, "",
                           is_turns_over_hertz
                               ? "2*pi over a frequency in Hz is neither a period nor a time constant"
                           : finding == UnitFinding::mixed ? "the expression mixes units"
                                                           : "the expression adds Hz and rad/s");
  p.found = metric.signal;
  for (size_t i = 0; i < ports.size(); ++i)
    p.found += fmt::format("{} {} in {}", i == 0 ? " with" : ",", ports[i], to_string(*units[i]));
  if (finding == UnitFinding::mixed_turns) p.hint = "2*pi times a frequency in Hz is in rad/s";
  return {};
}

}  // namespace loopwright
