/// The unit of what a function gives, from the units of its arguments alone.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>
#include "engine/unit/unit.h"

namespace loopwright {

/// A number in SI. Without a unit it is a bare number, which takes the unit that its user expects.
struct Quantity {
  double number = 0;
  std::optional<Unit> unit;
};

enum class UnitFinding {
  known,
  mixed,        ///< the function adds or compares different units
  mixed_turns,  ///< it adds hertz to radians per second
  zero,         ///< a zero fits every unit
  no_result,    ///< it gives no finite number
};

/// Every argument with a unit is given a generic positive number, and each base unit is made 1/λ as large, so
/// that an argument in m^a grows by λ^a. If the result grows by λ^b for λ = 2 and 3, b is its exponent;
/// otherwise the function mixes units. Arguments without unit keep their value.
///
/// π is a half cycle in radians, so that 2π f is in rad/s and ω/2π in Hz; `function` is therefore told what π
/// is. Radians and cycles are not checked: a function that takes them as plain numbers, as sin does, gives
/// none. They are kept of angles, times and frequencies only, and dropped of products such as m ω².
UnitFinding find_unit(const std::function<double(const std::vector<double>& arguments, double pi)>& function,
                      std::span<const Quantity> arguments, Unit& unit);

}  // namespace loopwright
