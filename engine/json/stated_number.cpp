#include "engine/json/stated_number.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include "engine/json/take_unit.h"
#include "engine/unit/scaled_rate.h"

namespace loopwright {
namespace {

StatedNumber with_unit(double number, const Unit& unit, std::string_view text) {
  StatedNumber stated;
  stated.number = number, stated.unit = unit, stated.unit_text = text;
  stated.at.kind = Value::Kind::number;
  stated.at.number = unit.to_si(number);
  stated.at.unit = kept_in_si(unit);
  return stated;
}

/// {"value": 5, "unit": "um"}
std::optional<StatedNumber> of_object(const Value& object, std::string_view what, const Reader& reader) {
  reader.reject_unknown(object, {"value", "unit"}, what);
  const Value::Member *number = object.find("value"), *unit_text = object.find("unit");
  if (!number || !unit_text) {
    reader.error(object, fmt::format("{} lacks its \"{}\"", what, number ? "unit" : "value")).expected =
        stated_number_form;
    return {};
  }
  if (!reader.expect(number->value, Value::Kind::number, "\"value\"", "a number")) return {};
  const auto unit = reader.unit(unit_text->value);
  if (!unit) return {};
  return with_unit(number->value.number, *unit, unit_text->value.text);
}

std::optional<StatedNumber> of_value(const Value& value, std::string_view what, const Reader& reader) {
  if (value.kind == Value::Kind::object) return of_object(value, what, reader);
  if (value.kind == Value::Kind::text)
    if (auto stated = number_and_unit(value.text)) return stated;
  if (!reader.expect(value, Value::Kind::number, what, stated_number_form)) return {};
  StatedNumber bare;
  bare.number = value.number, bare.at = value;
  return bare;
}

}  // namespace

const std::string_view stated_number_form = R"(a number, "5 um" or {"value": 5, "unit": "um"})";

std::optional<StatedNumber> number_and_unit(const std::string& text) {
  double number = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, number);
  if (error != std::errc() || !std::isfinite(number) || end == last) return {};
  std::string_view unit_text(end, last);
  unit_text.remove_prefix(std::min(unit_text.find_first_not_of(' '), unit_text.size()));
  const auto unit = parse_unit(unit_text);
  return unit ? std::optional(with_unit(number, *unit, unit_text)) : std::nullopt;
}

std::string hint_for_quoted_number(const std::string& text) {
  if (const auto stated = number_and_unit(text); stated && !stated->unit_text.empty())
    return fmt::format(R"(a number with a unit is written {{"value": {}, "unit": "{}"}})", stated->number,
                       stated->unit_text);
  return "a number stands without quotes; an expression starts with '=', as in \"=2*pi*40\"";
}

std::optional<StatedNumber> stated_number(const Value& value, std::string_view what, const Reader& reader,
                                          double low) {
  auto stated = of_value(value, what, reader);
  if (!stated) return {};
  stated->at.place = value.place;
  if (stated->number >= low) return stated;
  auto& p = reader.error(value, fmt::format("{} is out of range", what));
  p.expected = fmt::format("at least {:g}", low);
  p.found = fmt::format("{} {}", stated->number, stated->unit_text);
  return {};
}

std::optional<double> in_unit(const StatedNumber& stated, const Unit& unit, std::string_view what,
                              const Reader& reader, bool is_difference) {
  if (!stated.unit) return stated.number;
  if (is_difference && stated.unit->is_point) {
    auto& p = reader.error(stated.at, fmt::format("{} is a difference of temperatures", what));
    p.expected = "a number in K", p.found = stated.unit_text;
    return {};
  }
  if (*stated.unit == unit) return stated.number;
  const Conversion convert = conversion(*stated.at.unit, unit);
  if (convert.kind == Conversion::Kind::none || convert.kind == Conversion::Kind::turns) {
    const double in_si = convert(stated.at.number);
    return is_difference ? in_si / unit.scale : unit.from_si(in_si);
  }
  Value refused = stated.at;
  if (take_unit(refused, unit, reader) == UnitTaken::no) {
    auto& p = reader.error(stated.at, fmt::format("{} has another unit", what));
    p.expected = fmt::format("a number in {}", to_string(unit)), p.found = stated.unit_text;
  }
  return {};
}

}  // namespace loopwright
