#include "engine/plan/unit_expressions.h"
#include <algorithm>
#include <charconv>
#include <string>

namespace loopwright {

TypeUnits::TypeUnits(const BlockInfo& info) {
  for (const PortInfo& port : info.inputs) inputs_.push_back(&add(port.unit));
  for (const PortInfo& port : info.outputs) outputs_.push_back(&add(port.unit));
  for (const ParameterInfo& parameter : info.parameters) add_parameter(parameter);
  const auto position = std::ranges::find(names_, "position");
  if (info.room == "mechanics" && position != names_.end()) position_ = int(position - names_.begin());
}

void TypeUnits::add_parameter(const ParameterInfo& parameter) {
  add(parameter.unit);
  for (const ParameterInfo& element : parameter.element) add_parameter(element);
  for (const ParameterInfo& field : parameter.fields) add_parameter(field);
}

const UnitExpression& TypeUnits::add(std::string_view text) {
  const auto [entry, is_new] = parsed_.try_emplace(text);
  if (is_new) entry->second = parse(text);
  return entry->second;
}

/// "$command*s^2/m": factors separated by * and /; those with $ are variables.
UnitExpression TypeUnits::parse(std::string_view text) {
  UnitExpression expression;
  if (text.find('$') == text.npos) {
    expression.constant = parse_unit(text).value_or(Unit{});
    return expression;
  }
  std::string plain = "1";
  char before = '*';
  for (size_t i = 0; i <= text.size();) {
    const size_t end = std::min(text.find_first_of("*/", i), text.size());
    const std::string_view factor = text.substr(i, end - i);
    if (factor.starts_with('$')) {
      const size_t caret = factor.find('^');
      double exponent = 1;
      if (caret != factor.npos)
        std::from_chars(factor.data() + caret + 1, factor.data() + factor.size(), exponent);
      expression.factors.push_back({variable(factor.substr(1, std::min(caret, factor.size()) - 1)),
                                    before == '/' ? -exponent : exponent});
    } else {
      plain += before;
      plain += factor;
    }
    before = end < text.size() ? text[end] : '*';
    i = end + 1;
  }
  expression.constant = parse_unit(plain).value_or(Unit{});
  return expression;
}

int TypeUnits::variable(std::string_view name) {
  const auto index = std::ranges::find(names_, name) - names_.begin();
  if (index == std::ssize(names_)) names_.push_back(name);
  return int(index);
}

}  // namespace loopwright
