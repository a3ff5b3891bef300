/// The unit of the result of a function, from the units of its arguments alone.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>
#include "engine/unit/unit.h"

namespace loopwright {

/// A number in SI. Without a unit it is a bare number, which takes the unit expected where it is used.
struct Quantity {
  double number = 0;
  std::optional<Unit> unit;
};

enum class UnitFinding {
  known,
  mixed,        ///< the function adds or compares different units
  mixed_turns,  ///< the function adds hertz to radians per second
  zero,         ///< the result is zero, which fits every unit
  no_result,    ///< the result is non-finite
};

/// Every argument with a unit gets a generic positive value. Each base unit is divided by λ, so that an
/// argument in m^a grows by λ^a. If the result grows by λ^b for λ = 2 and 3, its exponent is b; otherwise the
/// function mixes units. Arguments without a unit keep their value.
///
/// π is a half cycle in radians, so that 2π f is in rad/s and ω/2π in Hz; `function` therefore receives π as
/// an argument. Radians and cycles are not checked. A function that takes them as plain numbers, such as sin,
/// has a result without them. Only angles, times and frequencies keep them; products such as m ω² do not.
UnitFinding find_unit(const std::function<double(const std::vector<double>& arguments, double pi)>& function,
                      std::span<const Quantity> arguments, Unit& unit);

}  // namespace loopwright
