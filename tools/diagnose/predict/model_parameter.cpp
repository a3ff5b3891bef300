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

/// ln(b₁/b₀) / ln(p₁/p₀), to the nearest quarter if that is what it is.
double power_of(double before, double after) {
  const double power = std::log(after / before) / std::log1p(change);
  const double quarter = std::round(4 * power) / 4;
  return std::abs(power - quarter) < 1e-3 ? quarter : power;
}

}  // namespace

void ModelParameter::set(double factor) const {
  for (const Number& number : numbers)
    *number.at = number.nominal * (factor == 1 ? 1 : std::pow(factor, number.power));
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
      found.numbers.push_back({run.parameter(own[i].path), own[i].value, power_of(own[i].value, *at)});
      is_determined[i] = true;
    }
    if (!found.numbers.empty()) list.push_back(std::move(found));
  }
  for (size_t i = 0; i < own.size(); ++i)
    if (!is_determined[i])
      list.push_back({own[i].path, "", own[i].value, {{run.parameter(own[i].path), own[i].value, 1.0}}});
  return list;
}

}  // namespace loopwright::diagnosis
