/// Numbers that a file states with a unit of their own: {"value": 5, "unit": "um"} or "5 um".
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include "engine/json/reader.h"

namespace loopwright {

/// A number as it is written. Without a unit it has the unit of its place.
struct StatedNumber {
  double number = 0;
  std::optional<Unit> unit;
  std::string unit_text;  ///< "um"
  Value at;               ///< in SI if it has a unit

  /// In SI, or as written if it has no unit.
  double as_given() const { return at.number; }
};

/// What may be written, for messages: "a number, "5 um" or {"value": 5, "unit": "um"}".
extern const std::string_view stated_number_form;

/// "25 mm"; nothing if the text is not a number and a unit.
std::optional<StatedNumber> number_and_unit(const std::string& text);

/// For text in the place of a number that takes a unit only as an object: what the user probably meant.
std::string hint_for_quoted_number(const std::string& text);

/// The number in the value; nothing after a problem. `low` is the least number that is allowed.
std::optional<StatedNumber> stated_number(const Value& value, std::string_view what, const Reader& reader,
                                          double low = -Reader::infinity);

/// The same number in `unit`: converted if it has another one, as it is without a unit. Nothing after a
/// problem: another dimension, or a unit that can mean two numbers. `is_difference`: takes K and rejects
/// degC.
std::optional<double> in_unit(const StatedNumber& stated, const Unit& unit, std::string_view what,
                              const Reader& reader, bool is_difference = false);

}  // namespace loopwright
