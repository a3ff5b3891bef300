/// Physical units as powers of the SI base units, read from text by udunits2.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace loopwright {

/// SI number = scale · number + offset, in m^e₀ kg^e₁ s^e₂ A^e₃ K^e₄ mol^e₅ cd^e₆ rad^e₇ cycle^e₈.
///
/// The radian is followed but not checked: v = ω r holds. The cycle is what hertz counts: Hz = cycle/s, while
/// rpm, rev and deg are radians. One cycle is 2π rad, so that Hz and rad/s convert into each other, and
/// neither stands for a plain 1/s unasked (`conversion`).
struct Unit {
  static constexpr size_t checked = 7;  ///< the first so many exponents are the dimension
  static constexpr size_t radian = 7, cycle = 8;

  double scale = 1.0;
  std::array<float, 9> exponents{};  ///< fractional powers (V/sqrt(Hz)) are allowed
  double offset = 0;                 ///< K; of temperatures with a zero of their own: degC, degF
  bool is_point = false;             ///< a point on such a scale, not a difference of two

  float radians() const { return exponents[radian]; }
  float cycles() const { return exponents[cycle]; }
  /// Of the SI base units; radians and cycles are not looked at.
  bool same_dimension(const Unit& other) const {
    for (size_t i = 0; i < checked; ++i)
      if (exponents[i] != other.exponents[i]) return false;
    return true;
  }
  /// Whether signals of both may meet: one dimension, and as many cycles. Radians are not looked at.
  bool fits(const Unit& other) const { return cycles() == other.cycles() && same_dimension(other); }
  bool operator==(const Unit&) const = default;

  double to_si(double number) const { return offset == 0 ? number * scale : number * scale + offset; }
  double from_si(double number) const { return offset == 0 ? number / scale : (number - offset) / scale; }
  /// The unit of what `to_si` gives.
  Unit in_si() const { return {1.0, exponents, 0, is_point}; }
};

Unit operator*(const Unit& a, const Unit& b);
Unit power(const Unit& a, double exponent);

/// The unit written as "N*s/m", "mm", "V*s^2/m", "rpm", "degC", "1" or "" (both dimensionless); nothing if it
/// cannot be read.
std::optional<Unit> parse_unit(std::string_view text);

/// A readable spelling: a named unit (N, V, Hz, rpm …) where one fits, else a product of base units; "1" when
/// dimensionless, "rad" for an angle.
std::string to_string(const Unit& unit);

/// How numbers in one unit, taken to SI, become those of another one.
struct Conversion {
  enum class Kind {
    none,        ///< the numbers are the same
    turns,       ///< 2π for each cycle
    ambiguous,   ///< cycles meet a plain number: 2π or 1
    impossible,  ///< another dimension
  };
  Kind kind = Kind::none;
  double cycles = 0;  ///< that become radians, with `turns`

  double operator()(double number) const;
};
Conversion conversion(const Unit& from, const Unit& to);

}  // namespace loopwright
