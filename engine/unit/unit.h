/// Physical units as powers of the SI base units, read from text by udunits2.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace loopwright {

/// scale · m^e₀ kg^e₁ s^e₂ A^e₃ K^e₄ mol^e₅ cd^e₆ ; radians count as 1.
struct Unit {
  double scale = 1.0;
  std::array<float, 7> exponents{};  ///< fractional powers (V/sqrt(Hz)) are allowed

  bool same_dimension(const Unit& other) const { return exponents == other.exponents; }
  bool operator==(const Unit& other) const { return scale == other.scale && exponents == other.exponents; }
};

Unit operator*(const Unit& a, const Unit& b);
Unit power(const Unit& a, double exponent);

/// The unit written as "N*s/m", "mm", "V*s^2/m", "1" or "" (both dimensionless); nothing if it cannot be
/// read. Units with an offset (degC) cannot be read: signals are in SI.
std::optional<Unit> parse_unit(std::string_view text);

/// A readable spelling: a named unit (N, V, Hz …) where one fits, else a product of base units; "1" when
/// dimensionless.
std::string to_string(const Unit& unit);

}  // namespace loopwright
