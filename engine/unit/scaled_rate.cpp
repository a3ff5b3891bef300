#include "engine/unit/scaled_rate.h"
#include <cmath>

namespace loopwright {

bool is_scaled_rate(const Unit& unit) {
  constexpr double rounding = 1e-9;  // of a scale that was multiplied and divided
  constexpr size_t time = 2;
  if (!(unit.exponents[time] < 0) || std::abs(unit.scale - 1) <= rounding) return false;
  for (size_t i = 0; i < unit.exponents.size(); ++i)
    if (i != time && unit.exponents[i] != 0) return false;
  return true;
}

Unit kept_in_si(const Unit& unit) {
  Unit kept = unit.in_si();
  if (is_scaled_rate(unit)) kept.scale = unit.scale;
  return kept;
}

}  // namespace loopwright
