#include "tools/effects/effect_values.h"
#include <limits>
#include "engine/diagram/expression.h"

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

EffectValues values_of(const Effect& effect, const RecordSizes& sizes, const std::vector<double>& fitted) {
  EffectValues values(sizes);
  size_t next = 0;
  for (const EffectParameter& parameter : effect.parameters)
    if (parameter.is_fitted) values.set(parameter.name, next < fitted.size() ? fitted[next++] : 0.0);
  values.work_out(effect);
  return values;
}

}  // namespace loopwright
