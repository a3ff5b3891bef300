#include "tools/diagnose/predict/model_parameter.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "engine/run/run.h"

namespace loopwright::diagnosis {
namespace {

constexpr double change = 1e-3;  // relative, of a parameter whose readers are looked for

struct Tunable {
  std::string path, unit;
  double value;

  /// Empty if it follows from what is wired: "$y/$u".
  std::string own_unit() const { return unit.find('$') == unit.npos ? unit : ""; }
};

/// The number at a path, or those of the objects in the list there, such as the constants of an Expression.
/// False if there is nothing.
bool add_tunables(const std::string& path, const ParameterInfo& info, Run<double>& run,
                  std::vector<Tunable>& list) {
  if (const double* at = run.parameter(path)) {
    if (std::isfinite(*at) && *at != 0) list.push_back({path, std::string(info.unit), *at});
    return true;
  }
  bool has_any = false;
  for (const ParameterInfo& field : info.fields) {
    if (info.kind == ParameterKind::object)
      has_any |= add_tunables(path + "." + std::string(field.name), field, run, list);
    for (size_t i = 0; info.kind == ParameterKind::list; ++i, has_any = true)
      if (!add_tunables(fmt::format("{}.{}.{}", path, i, field.name), field, run, list)) break;
  }
  return has_any;
}

/// The plain numbers of blocks that are not sources: a source is recorded or known.
std::vector<Tunable> tunables(const Plan& plan, Run<double>& run) {
  std::vector<Tunable> list;
  for (const Plan::Block& block : plan.blocks) {
    if (block.inputs.empty()) continue;
    for (const ParameterInfo& info : block.type->info.parameters)
      add_tunables(block.path + "." + std::string(info.name), info, run, list);
  }
  return list;
}

/// The power ln(b₁/b₀) / ln(p₁/p₀): of a law, to the nearest quarter. What is in between is no law, but the
/// share (b₁ - b₀)/b₀ / ((p₁ - p₀)/p₀) of a sum.
ModelParameter::Number dependence(double* at, double before, double after) {
  constexpr double same_power = 1e-9;  // rounding, divided by the change
  const double power = std::log(after / before) / std::log1p(change);
  const double quarter = std::round(4 * power) / 4;
  if (std::abs(power - quarter) < same_power) return {at, before, quarter};
  const double share = (after / before - 1) / change;
  if (share > 0 && share < 1) return {at, before, share, true};
  return {at, before, power};
}

}  // namespace

void set_parameters(std::span<const ModelParameter> parameters, std::span<const double> factors) {
  for (const ModelParameter& parameter : parameters)
    for (const ModelParameter::Number& number : parameter.numbers) *number.at = number.nominal;
  for (const bool of_shares : {true, false})  // sums are multiplied as a whole
    for (size_t i = 0; i < parameters.size(); ++i) {
      if (factors[i] == 1) continue;
      for (const ModelParameter::Number& number : parameters[i].numbers) {
        if (number.is_share != of_shares) continue;
        if (of_shares)
          *number.at += number.nominal * number.power * (factors[i] - 1);
        else
          *number.at *= std::pow(factors[i], number.power);
      }
    }
}

void ModelParameter::refer_to(double other) {
  for (Number& number : numbers)
    if (number.power == 1 && nominal != other) number.power = other / nominal, number.is_share = true;
  nominal = other;
}

std::vector<ModelParameter> find_parameters(const std::string& diagram, const LoadOptions& options,
                                            const Diagram& loaded, const Plan& plan, Run<double>& run) {
  const std::vector<Tunable> own = tunables(plan, run);
  std::vector<bool> is_determined(own.size(), false);
  std::vector<ModelParameter> list;
  for (const Parameter& parameter : loaded.parameters) {
    if (parameter.value.kind != Value::Kind::number || parameter.value.number == 0) continue;
    LoadOptions changed = options;
    const double other = parameter.value.number * (1 + change);
    changed.set.emplace_back(parameter.name,
                             fmt::format("{}", parameter.unit ? parameter.unit->from_si(other) : other));
    Problems problems;
    const auto there = load_diagram(diagram, changed, problems);
    const auto compiled = there ? compile(*there, problems) : nullptr;
    if (!compiled || problems.has_errors()) continue;
    Run<double> another(*compiled);
    ModelParameter found{parameter.name,
                         parameter.unit ? to_string(parameter.unit->in_si()) : "1",
                         parameter.value.number,
                         {}};
    for (size_t i = 0; i < own.size(); ++i) {
      const double* at = another.parameter(own[i].path);
      if (!at || *at == own[i].value || !(*at / own[i].value > 0)) continue;
      found.numbers.push_back(dependence(run.parameter(own[i].path), own[i].value, *at));
      is_determined[i] = true;
    }
    if (!found.numbers.empty()) list.push_back(std::move(found));
  }
  for (size_t i = 0; i < own.size(); ++i)
    if (!is_determined[i])
      list.push_back(
          {own[i].path, own[i].own_unit(), own[i].value, {{run.parameter(own[i].path), own[i].value, 1.0}}});
  return list;
}

}  // namespace loopwright::diagnosis
