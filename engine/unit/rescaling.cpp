#include "engine/unit/rescaling.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include "engine/unit/scaled_rate.h"
#include "models/real/double_functions.h"

namespace loopwright {
namespace {

using Function = std::function<double(const std::vector<double>&, double)>;

constexpr double no_power = std::numeric_limits<double>::quiet_NaN();

/// Rates such as 1/min are rescaled like a base unit of their own.
constexpr size_t scaled_rate = Unit::cycle + 1;

float exponent_of(const Unit& unit, size_t base) {
  return base != scaled_rate ? unit.exponents[base] : is_scaled_rate(unit) ? 1.0f : 0.0f;
}

/// b in f ~ λ^b, a multiple of 1/12; NaN if f is not a power of λ.
double exponent_of_growth(double at_one, double at_two, double at_three) {
  const auto rounded = [at_one](double grown, double lambda) {
    const double exponent = natural_logarithm(grown / at_one) / natural_logarithm(lambda);
    const double nearest = std::round(exponent * 12) / 12;
    return std::abs(exponent - nearest) < 1e-9 ? nearest : no_power;
  };
  const double from_two = rounded(at_two, 2), from_three = rounded(at_three, 3);
  return from_two == from_three ? from_two : no_power;
}

/// The function with one set of argument values.
class Rescaled {
 public:
  Rescaled(const Function& function, std::span<const Quantity> arguments, std::vector<double> numbers)
      : function_(function), arguments_(arguments), numbers_(std::move(numbers)) {
    at_one_ = function_(numbers_, std::numbers::pi);
  }
  double at_one() const { return at_one_; }

  /// The exponent of the result when the units of these base exponents become smaller.
  double exponent(std::initializer_list<size_t> bases) const {
    const auto grown = [&](double lambda) {
      std::vector<double> rescaled = numbers_;
      double of_pi = 0;
      for (const size_t base : bases) {
        if (base == Unit::radian) of_pi += 1;
        if (base == Unit::cycle) of_pi -= 1;
        for (size_t i = 0; i < arguments_.size(); ++i)
          if (arguments_[i].unit)
            rescaled[i] *= any_power(lambda, double{exponent_of(*arguments_[i].unit, base)});
      }
      return function_(rescaled, of_pi == 0 ? std::numbers::pi : std::numbers::pi * any_power(lambda, of_pi));
    };
    return exponent_of_growth(at_one_, grown(2), grown(3));
  }

  bool has(size_t base) const {
    return std::ranges::any_of(
        arguments_, [base](const Quantity& q) { return q.unit && exponent_of(*q.unit, base) != 0; });
  }
  /// Of the first argument that is a rate such as 1/min.
  double scale_of_rate() const {
    for (const Quantity& q : arguments_)
      if (q.unit && is_scaled_rate(*q.unit)) return q.unit->scale;
    return 1;
  }

 private:
  const Function& function_;
  std::span<const Quantity> arguments_;
  std::vector<double> numbers_;
  double at_one_ = 0;
};

bool is_kinematic(const Unit& unit) {
  bool is_time = true;
  for (size_t i = 0; i < Unit::checked; ++i) is_time &= i == 2 || unit.exponents[i] == 0;
  return is_time;
}

/// Only rad, rad/s, Hz, 1/Hz and the like keep turns: m ω² is a stiffness.
void drop_turns_of_products(Unit& unit) {
  const float turns = std::abs(unit.radians()) + std::abs(unit.cycles());
  if (!is_kinematic(unit) || turns != 1) unit.exponents[Unit::radian] = unit.exponents[Unit::cycle] = 0;
}

bool is_power_of_time(const Unit& unit, float exponent) {
  return unit.same_dimension({1.0, {0, 0, exponent}});
}

UnitFinding find_turns(const Rescaled& f, Unit& unit) {
  const double radians = f.exponent({Unit::radian}), cycles = f.exponent({Unit::cycle});
  if (!f.has(Unit::radian) && !f.has(Unit::cycle)) {
    if (is_power_of_time(unit, -1) && radians == 1) unit.exponents[Unit::radian] = 1;  // 2π/T of a period T
    return UnitFinding::known;
  }
  const bool adds_turns = std::isnan(radians) || (radians == 0 && std::isnan(cycles));
  const bool adds_rate = adds_turns && f.has(scaled_rate) && std::isnan(f.exponent({scaled_rate}));
  if (adds_rate && is_kinematic(unit)) return UnitFinding::mixed_turns;
  const bool adds_both =
      std::isnan(radians) && std::isnan(cycles) && f.has(Unit::radian) && f.has(Unit::cycle);
  if (adds_both && !std::isnan(f.exponent({Unit::radian, Unit::cycle}))) return UnitFinding::mixed_turns;
  unit.exponents[Unit::radian] = std::isnan(radians) ? 0 : static_cast<float>(radians);
  unit.exponents[Unit::cycle] = std::isnan(cycles) ? 0 : static_cast<float>(cycles);
  const bool is_turns_over_hertz = is_power_of_time(unit, 1) && radians == 1 && cycles == -2;
  if (!is_turns_over_hertz) drop_turns_of_products(unit);  // 2π/f is no time: both 1/f and 1/(2πf) are
  return UnitFinding::known;
}

/// The unit from one set of argument values.
UnitFinding unit_at(const Rescaled& f, Unit& unit) {
  if (!std::isfinite(f.at_one())) return UnitFinding::no_result;
  if (f.at_one() == 0) return UnitFinding::zero;
  for (size_t base = 0; base < Unit::checked; ++base) {
    if (!f.has(base)) continue;
    const double exponent = f.exponent({base});
    if (std::isnan(exponent)) return UnitFinding::mixed;
    unit.exponents[base] = static_cast<float>(exponent);
  }
  const UnitFinding finding = find_turns(f, unit);
  // A multiple of a rate such as 1/min, and a sum with one, is as ambiguous as the rate.
  Unit rate = unit;
  rate.scale = f.scale_of_rate();
  if (is_scaled_rate(rate) && f.exponent({scaled_rate}) != 0) unit.scale = rate.scale;
  return finding;
}

}  // namespace

/// Uses values of several magnitudes: a small constant of the wrong unit shows only beside small values.
UnitFinding find_unit(const Function& function, std::span<const Quantity> arguments, Unit& unit) {
  UnitFinding finding = UnitFinding::no_result;
  for (const double magnitude : {1.0, 1e-6, 1e6}) {
    std::vector<double> numbers;
    for (size_t i = 0; i < arguments.size(); ++i) {
      const double generic =
          magnitude * (1 + std::fmod(0.6180339887498949 * static_cast<double>(i + 1), 1.0));
      numbers.push_back(arguments[i].unit ? generic : arguments[i].number);
    }
    Unit here;
    const UnitFinding found = unit_at(Rescaled(function, arguments, std::move(numbers)), here);
    if (found == UnitFinding::no_result) continue;
    if (found == UnitFinding::mixed || found == UnitFinding::mixed_turns) return found;
    if (found == UnitFinding::zero) {
      if (finding == UnitFinding::no_result) finding = found;
      continue;
    }
    if (finding == UnitFinding::known && !unit.same_dimension(here)) return UnitFinding::mixed;
    if (finding == UnitFinding::known && !(unit == here))
      here.exponents[Unit::radian] = here.exponents[Unit::cycle] = 0;
    unit = here;
    finding = found;
  }
  return finding;
}

}  // namespace loopwright
