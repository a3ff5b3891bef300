#include "tools/diagnose/predict/model_parameter.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
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
    if (std::isfinite(*at)) list.push_back({path, std::string(info.unit), *at});
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

/// The power ln(b₁/b₀) / ln(p₁/p₀) of a law, to the nearest quarter; empty: it is none.
std::optional<double> power_of(double before, double after) {
  constexpr double same_power = 1e-9;  // rounding, divided by the change
  if (!(after / before > 0)) return {};
  const double power = std::log(after / before) / std::log1p(change);
  const double quarter = std::round(4 * power) / 4;
  return std::abs(power - quarter) < same_power ? std::optional(quarter) : std::nullopt;
}

/// The blocks of a diagram with other values of parameters; empty if it is none.
struct Changed {
  std::shared_ptr<const Plan> plan;
  std::unique_ptr<Run<double>> run;

  Changed(const std::string& diagram, LoadOptions options, std::span<const ModelParameter> parameters,
          std::span<const double> factors) {
    for (size_t i = 0; i < parameters.size(); ++i) {
      if (factors[i] == 1 || !parameters[i].is_of_diagram) continue;
      const double value = parameters[i].value_at(factors[i]);
      const auto& unit = parameters[i].stated_in;
      options.set.emplace_back(parameters[i].name, fmt::format("{}", unit ? unit->from_si(value) : value));
    }
    Problems problems;
    const auto loaded = load_diagram(diagram, options, problems);
    plan = loaded ? compile(*loaded, problems) : nullptr;
    if (problems.has_errors()) plan = nullptr;
    if (plan) run = std::make_unique<Run<double>>(*plan);
  }
  double at(const std::string& path) const {
    const double* number = run ? run->parameter(path) : nullptr;
    return number ? *number : std::numeric_limits<double>::quiet_NaN();
  }
};

/// What the powers of all parameters make of the number at a place.
double product_at(const double* at, std::span<const ModelParameter> parameters,
                  std::span<const double> factors) {
  double product = 1;
  for (size_t i = 0; i < parameters.size(); ++i)
    for (const ModelParameter::Number& number : parameters[i].numbers)
      if (number.at == at)
        product *= std::pow(parameters[i].value_at(factors[i]) / parameters[i].own, number.power);
  return product;
}

}  // namespace

void StatedNumbers::add(std::string path, double* at) {
  if (std::ranges::find(numbers_, at, &Number::at) == numbers_.end())
    numbers_.push_back({std::move(path), at, *at});
}

void StatedNumbers::act_on(Run<double>& run) {
  for (Number& number : numbers_) number.at = run.parameter(number.path);
}

void ModelParameters::act_on(Run<double>& run) {
  for (ModelParameter& parameter : list)
    for (ModelParameter::Number& number : parameter.numbers) number.at = run.parameter(number.path);
  stated.act_on(run);
}

std::vector<double> StatedNumbers::read(std::span<const ModelParameter> parameters,
                                        std::span<const double> factors) const {
  const Changed changed(diagram_, options_, parameters, factors);
  std::vector<double> values;
  for (const Number& number : numbers_) values.push_back(changed.at(number.path));
  return values;
}

void StatedNumbers::set(std::span<const ModelParameter> parameters, std::span<const double> factors) {
  constexpr size_t most_known = 32;
  if (numbers_.empty()) return;
  if (std::ranges::all_of(factors, [](double factor) { return factor == 1; })) {
    for (const Number& number : numbers_) *number.at = number.nominal;
    return;
  }
  auto known =
      std::ranges::find_if(known_, [&](const Known& k) { return std::ranges::equal(k.factors, factors); });
  if (known == known_.end()) {
    if (known_.size() == most_known) known_.erase(known_.begin());
    known_.push_back({{factors.begin(), factors.end()}, read(parameters, factors)});
    known = known_.end() - 1;
  }
  for (size_t i = 0; i < numbers_.size(); ++i) *numbers_[i].at = known->values[i];
}

void ModelParameters::set(std::span<const double> factors) {
  for (const ModelParameter& parameter : list)
    for (const ModelParameter::Number& number : parameter.numbers) *number.at = number.nominal;
  stated.set(list, factors);
  for (size_t i = 0; i < list.size(); ++i) {
    if (factors[i] == 1) continue;
    const double ratio = list[i].value_at(factors[i]) / list[i].own;
    for (const ModelParameter::Number& number : list[i].numbers) *number.at *= std::pow(ratio, number.power);
  }
}

namespace {

/// The parameters of the diagram, and the power of each in the numbers of blocks; whatever is no product of
/// powers, also where all of them change, is read from the diagram.
class OfDiagram {
 public:
  OfDiagram(const std::string& diagram, const LoadOptions& options, const std::vector<Tunable>& own,
            Run<double>& run)
      : diagram_(diagram), options_(options), own_(own), run_(run), is_determined_(own.size(), false) {
    found_.stated = {diagram, options};
  }

  void add(const Parameter& parameter) {
    const double value = parameter.value.number;
    ModelParameter one{parameter.name,
                       parameter.unit ? to_string(parameter.unit->in_si()) : "1",
                       value,
                       value,
                       parameter.unit,
                       true,
                       {}};
    const double factor = 1 + change;
    const Changed there(diagram_, options_, {&one, 1}, {&factor, 1});
    if (!there.run) return;
    bool is_read = false;
    for (size_t i = 0; i < own_.size(); ++i) {
      const double after = there.at(own_[i].path);
      if (std::isnan(after) || after == own_[i].value) continue;
      is_read = is_determined_[i] = true;
      const auto power = power_of(own_[i].value, after);
      if (power)
        one.numbers.push_back({own_[i].path, run_.parameter(own_[i].path), own_[i].value, *power});
      else
        found_.stated.add(own_[i].path, run_.parameter(own_[i].path)), is_stated_.insert(i);
    }
    if (is_read) found_.list.push_back(std::move(one));
  }

  ModelParameters take() {
    state_what_is_no_product();
    for (ModelParameter& parameter : found_.list)
      std::erase_if(parameter.numbers, [&](const ModelParameter::Number& number) {
        return std::ranges::any_of(is_stated_,
                                   [&](size_t i) { return run_.parameter(own_[i].path) == number.at; });
      });
    for (size_t i = 0; i < own_.size(); ++i)
      if (!is_determined_[i] && own_[i].value != 0)
        found_.list.push_back({own_[i].path,
                               own_[i].own_unit(),
                               own_[i].value,
                               own_[i].value,
                               {},
                               false,
                               {{own_[i].path, run_.parameter(own_[i].path), own_[i].value, 1.0}}});
    return std::move(found_);
  }

 private:
  /// All parameters a few per cent off, each by a factor of its own, so that no two cancel.
  void state_what_is_no_product() {
    constexpr double same = 1e-6;  // relative: rounding is far smaller, the terms of a sum far larger
    std::vector<double> factors;
    for (size_t i = 0; i < found_.list.size(); ++i) factors.push_back(1.02 + 0.01 * double(i % 9));
    const Changed there(diagram_, options_, found_.list, factors);
    for (size_t i = 0; i < own_.size() && there.run; ++i) {
      if (!is_determined_[i]) continue;
      double* at = run_.parameter(own_[i].path);
      const double product = own_[i].value * product_at(at, found_.list, factors);
      if (std::abs(there.at(own_[i].path) - product) <= same * std::abs(product)) continue;
      found_.stated.add(own_[i].path, at), is_stated_.insert(i);
    }
  }

  const std::string& diagram_;
  const LoadOptions& options_;
  const std::vector<Tunable>& own_;
  Run<double>& run_;
  std::vector<bool> is_determined_;
  std::set<size_t> is_stated_;
  ModelParameters found_;
};

}  // namespace

ModelParameters find_parameters(const std::string& diagram, const LoadOptions& options, const Diagram& loaded,
                                const Plan& plan, Run<double>& run) {
  const std::vector<Tunable> own = tunables(plan, run);
  OfDiagram found(diagram, options, own, run);
  for (const Parameter& parameter : loaded.parameters)
    if (parameter.value.kind == Value::Kind::number && parameter.value.number != 0) found.add(parameter);
  return found.take();
}

}  // namespace loopwright::diagnosis
