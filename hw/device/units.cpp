#include "hw/device/units.h"
#include <fmt/format.h>
#include <algorithm>
#include "engine/json/take_unit.h"

namespace loopwright::hw {
namespace {

void replace(std::string& text, std::string_view symbol, const std::string& by) {
  if (const size_t at = text.find(symbol); at != text.npos) text.replace(at, symbol.size(), by);
}

/// A product or quotient needs parentheses.
std::string as_factor(const std::string& unit) {
  const bool is_simple = std::ranges::all_of(unit, [](unsigned char c) { return std::isalnum(c); });
  return is_simple ? unit : "(" + unit + ")";
}

}  // namespace

std::string ChannelUnits::in_place_of(std::string_view described) const {
  if (described == "$unit") return unit;
  std::string text(described);
  replace(text, "$unit", unit.empty() ? "1" : as_factor(unit));
  replace(text, "/$raw", per_raw);
  return text;
}

void take_number(Value& number, std::string_view name, const std::string& wanted, const Reader& reader) {
  if (number.kind != Value::Kind::number || !number.unit) return;
  const auto unit = parse_unit(wanted);
  if (!unit) return;  // reported with the unit of the channel
  const UnitTaken taken = take_unit(number, *unit, reader);
  if (taken == UnitTaken::no) {
    auto& p = reader.error(number, fmt::format("the unit does not fit \"{}\"", name));
    p.expected = *unit == Unit{} ? "a number without a unit" : fmt::format("a number in {}", wanted);
    p.found = fmt::format("{:g} {}", number.unit->from_si(number.number), shown_unit(number));
    if (name == "scale") p.hint = "value = scale * raw + offset; the raw number of an analog channel is in V";
  }
  if (taken == UnitTaken::yes)
    number.unit = {};
  else
    number.kind = Value::Kind::null, number.is_broken = true;
}

}  // namespace loopwright::hw
