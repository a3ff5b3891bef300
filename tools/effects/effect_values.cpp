#include "tools/effects/effect_values.h"
#include <fmt/format.h>
#include <algorithm>
#include <limits>
#include "engine/diagram/expression.h"
#include "tools/effects/json_text.h"

namespace loopwright {

EffectValues::EffectValues(const RecordSizes& sizes) {
  for (const NamedSize& size : record_sizes) set(size.name, sizes.*size.value);
}

void EffectValues::work_out(const Effect& effect) {
  for (const EffectParameter& parameter : effect.parameters)
    if (!parameter.is_fitted) set(parameter.name, evaluate(parameter.value));
}

double EffectValues::evaluate(const Value& value) const {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (value.kind == Value::Kind::number) return value.number;
  if (value.kind != Value::Kind::text || !value.text.starts_with('=')) return unknown;
  const std::string_view formula = std::string_view(value.text).substr(1);
  if (const auto plain = numbers_.find(formula); plain != numbers_.end()) return plain->second;
  Quantity quantity;
  ExpressionSite site{value.place, "", {}};
  site.lookup = [&](const NameUse& use, const Place&) -> const Quantity* {
    const auto found = numbers_.find(use.name);
    quantity.number = found == numbers_.end() ? unknown : found->second;
    return &quantity;
  };
  Problems problems;
  const auto result = loopwright::evaluate(formula, site, problems);
  return result ? result->number : unknown;
}

std::string EffectValues::with_unit(const Value& value, const Effect& effect,
                                    const MachineUnits& units) const {
  // A clock may be that of the day.
  const bool is_by_clock = value.kind == Value::Kind::text && value.text == "=record_start";
  const double exact = evaluate(value);
  const std::string number = is_by_clock ? fmt::format("{}", exact) : readable_number(exact);
  if (value.kind != Value::Kind::text || !value.text.starts_with('=')) return number;
  Quantity quantity;
  ExpressionSite site{value.place, "", {}};
  site.lookup = [&](const NameUse& use, const Place&) -> const Quantity* {
    const EffectParameter* parameter = effect.find(use.name);
    const auto size = std::ranges::find(record_sizes, use.name, &NamedSize::name);
    const std::string_view by_role = parameter                    ? parameter->unit
                                     : size != record_sizes.end() ? size->unit
                                                                  : "";
    quantity = {at(use.name), by_role.empty() ? std::nullopt : parse_unit(unit_in(by_role, units))};
    if (quantity.unit) quantity.unit = quantity.unit->in_si();
    return &quantity;
  };
  Problems problems;  // of the effect's own text, which was checked when it was loaded
  const auto result = loopwright::evaluate(std::string_view(value.text).substr(1), site, problems);
  if (!result || !result->unit || result->unit->fits(Unit{})) return number;
  return fmt::format(R"({{"value": {}, "unit": "{}"}})", number, to_string(*result->unit));
}

EffectValues values_of(const Effect& effect, const RecordSizes& sizes, const std::vector<double>& fitted) {
  EffectValues values(sizes);
  size_t next = 0;
  for (const EffectParameter& parameter : effect.parameters)
    if (parameter.is_fitted) values.set(parameter.name, next < fitted.size() ? fitted[next++] : 0.0);
  values.work_out(effect);
  return values;
}

}  // namespace loopwright
