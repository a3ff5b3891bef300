/// Physical units as powers of the SI base units, read from text by udunits2.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace loopwright {

/// SI number = scale · number + offset, in m^e₀ kg^e₁ s^e₂ A^e₃ K^e₄ mol^e₅ cd^e₆ rad^e₇ cycle^e₈.
///
/// The radian is recorded but not checked: v = ω r is valid. The cycle is what hertz counts: Hz = cycle/s,
/// while rpm, rev and deg are radians. One cycle is 2π rad, so Hz and rad/s convert into each other. Neither
/// is converted implicitly to a plain 1/s (see `conversion`).
struct Unit {
  static constexpr size_t checked = 7;  ///< the number of leading exponents that form the dimension
  static constexpr size_t radian = 7, cycle = 8;

  double scale = 1.0;
  std::array<float, 9> exponents{};  ///< fractional powers (V/sqrt(Hz)) are allowed
  double offset = 0;                 ///< K; of temperatures with an offset: degC, degF
  bool is_point = false;             ///< a point on such a scale, not a difference

  float radians() const { return exponents[radian]; }
  float cycles() const { return exponents[cycle]; }
  /// Compares the SI base units; radians and cycles are ignored.
  bool same_dimension(const Unit& other) const {
    for (size_t i = 0; i < checked; ++i)
      if (exponents[i] != other.exponents[i]) return false;
    return true;
  }
  /// Whether signals of both units may be connected: same dimension and same cycles. Radians are ignored.
  bool fits(const Unit& other) const { return cycles() == other.cycles() && same_dimension(other); }
  bool operator==(const Unit&) const = default;

  double to_si(double number) const { return offset == 0 ? number * scale : number * scale + offset; }
  double from_si(double number) const { return offset == 0 ? number / scale : (number - offset) / scale; }
  /// The unit of the result of `to_si`.
  Unit in_si() const { return {1.0, exponents, 0, is_point}; }
};

Unit operator*(const Unit& a, const Unit& b);
Unit power(const Unit& a, double exponent);

/// The unit in a text such as "N*s/m", "mm", "V*s^2/m", "rpm", "degC", "1" or "" (both dimensionless);
/// nothing if it cannot be read.
std::optional<Unit> parse_unit(std::string_view text);

/// Whether it counts increments ("counts", "pulses/s", "LSB"): a plain number for the arithmetic, but no
/// angle.
bool is_counted(std::string_view text);

/// A readable spelling: a named unit (N, V, Hz, rpm …) if one fits, otherwise a product of base units; "1" if
/// dimensionless, "rad" for an angle.
std::string to_string(const Unit& unit);

/// The conversion of numbers in one unit, after conversion to SI, to another unit.
struct Conversion {
  enum class Kind {
    none,        ///< the numbers are the same
    turns,       ///< 2π for each cycle
    ambiguous,   ///< cycles and a plain number: 2π or 1
    impossible,  ///< another dimension
  };
  Kind kind = Kind::none;
  double cycles = 0;  ///< number of cycles converted to radians, with `turns`

  double operator()(double number) const;
};
Conversion conversion(const Unit& from, const Unit& to);

}  // namespace loopwright
