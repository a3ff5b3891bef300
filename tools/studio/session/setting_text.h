/// Values as a user types and reads them: 25 mm, =2*pi*f, true, paper.
#pragma once
#include <optional>
#include <string>
#include "engine/block/parameters.h"
#include "engine/diagram/diagram.h"
#include "tools/studio/session/text_change.h"

namespace loopwright::studio {

/// A value of a file as a user would type it.
std::string typed_text(const Value& value);

/// The JSON of what was typed; for `info` null, of any value. Throws Refused for what is no value.
std::string json_of_typed(const std::string& typed, const ParameterInfo* info);

/// The same in place of a value: a bare number or an expression keeps the unit that stands there, and a
/// number with a unit the description.
TextChanges retyped(const Value& old, const std::string& typed, const ParameterInfo* info);

/// An evaluated number with its unit, or another value: "0.2621 kg".
std::string shown_value(const Value& value, const std::string& unit);

/// The parameter that a path leads to, "harmonics.0.amplitude"; null if there is none.
const ParameterInfo* find_parameter(const std::vector<ParameterInfo>& list,
                                    std::span<const std::string> path);

/// Where a slider may move, in the unit of the number.
struct Slider {
  double low = 0, high = 0, value = 0;
  std::string unit;  ///< for the number with which a run is set
};
/// Around a number in SI, which is shown in `unit`, within the limits of its parameter. Nothing if it cannot
/// move.
std::optional<Slider> slider_around(double si, const std::string& unit, const ParameterInfo* info);

}  // namespace loopwright::studio
