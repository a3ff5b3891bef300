#include "tools/effects/bound.h"
#include <fmt/format.h>
#include <algorithm>
#include "engine/diagram/expression.h"

namespace loopwright {

RecordSizes example_sizes() {
  RecordSizes sizes;
  for (const NamedSize& size : record_sizes) sizes.*size.value = 1;
  sizes.lowest_position = -0.4, sizes.highest_position = 0.6, sizes.resolution = 1e-6, sizes.duration = 10,
  sizes.sample_time = 1e-3;
  return sizes;
}

namespace {

/// With every quantity and its unit.
std::vector<Quantity> example_quantities() {
  const RecordSizes sizes = example_sizes();
  std::vector<Quantity> quantities;
  for (const NamedSize& size : record_sizes)
    quantities.push_back({sizes.*size.value, parse_unit(unit_in(size.unit, {}))});
  return quantities;
}

}  // namespace

double example_of_bound(const Value& value, const std::string& unit, const Reader& reader) {
  if (value.kind == Value::Kind::number) return value.number;
  if (!reader.expect(value, Value::Kind::text, "a bound",
                     "a number, or an expression such as \"=0.1*stroke\""))
    return 0;
  if (!value.text.starts_with('=')) {
    reader.error(value, "this is no expression").expected = "a number, or \"=\" and an expression";
    return 0;
  }
  const std::vector<Quantity> quantities = example_quantities();
  ExpressionSite site{value.place, "", {}};
  site.lookup = [&](const NameUse& use, const Place& place) -> const Quantity* {
    for (size_t i = 0; i < record_sizes.size(); ++i)
      if (record_sizes[i].name == use.name) return &quantities[i];
    auto& p = reader.problems.error(place, value.place.pointer(), "",
                                    fmt::format("there is no size \"{}\"", use.name));
    KnownNames names;
    for (const NamedSize& size : record_sizes) names.add(std::string(size.name));
    names.explain(p, use.name);
    return nullptr;
  };
  const auto result = evaluate(std::string_view(value.text).substr(1), site, reader.problems);
  if (!result) return 0;
  const auto wanted = parse_unit(unit_in(unit, {}));
  if (result->unit && wanted && !result->unit->same_dimension(*wanted)) {
    auto& p = reader.error(value, "the expression has another unit than its parameter");
    p.expected = to_string(*wanted), p.found = to_string(*result->unit);
  }
  return result->number;
}

}  // namespace loopwright
