/// Times as exact fractions of integers.
#pragma once
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

namespace loopwright {

/// A time in seconds as a fraction in lowest terms, both parts positive (numerator may be 0).
struct Fraction {
  int64_t numerator = 0, denominator = 1;
  double value() const { return double(numerator) / double(denominator); }
  bool operator==(const Fraction&) const = default;
};

inline constexpr int64_t largest_denominator = 2'000'000'000, largest_numerator = 2'000'000'000'000;

// Static, so that a function compiled for one instruction set is never linked into code for another.

/// A decimal with up to nine places that is no simple fraction, exactly. Nothing for any other number.
[[maybe_unused]] static std::optional<Fraction> to_decimal_fraction(double x, double distance) {
  constexpr int64_t places = 1'000'000'000;
  const double count = std::round(x * double(places));
  if (!(count < 9e15) || std::abs(count / double(places) - x) > distance) return {};
  const int64_t numerator = int64_t(count), shared = std::gcd(numerator, places);
  if (numerator / shared > largest_numerator) return {};
  return Fraction{numerator / shared, places / shared};
}

/// The simplest fraction within this relative distance, and within a nanosecond, of x >= 0: 0.001 gives
/// 1/1000, 1.0/3 gives 1/3. Where that needs a large denominator, a decimal with nine places is kept as it
/// is: 0.000666666 and seven times as much then have a common divisor. Nothing if x is not finite, negative,
/// above 2e12, or needs a denominator of more than nine digits.
[[maybe_unused]] static std::optional<Fraction> to_fraction(double x, double relative = 1e-12) {
  constexpr double nearest = 1e-9;  // s: times that differ by more are regarded as different
  constexpr int64_t simple = 100'000;
  if (!std::isfinite(x) || x < 0) return {};
  if (x == 0) return Fraction{0, 1};
  const double distance = std::fmin(relative * x, nearest);
  // Continued fraction: convergents p/q until one is close enough.
  int64_t p0 = 0, q0 = 1, p1 = 1, q1 = 0;
  double rest = x;
  for (int i = 0; i < 40; ++i) {
    const double whole = std::floor(rest);
    if (whole > double(i ? largest_denominator : largest_numerator)) return {};
    const auto a = int64_t(whole);
    int64_t p2 = 0, q2 = 0;
    if (__builtin_mul_overflow(a, p1, &p2) || __builtin_add_overflow(p2, p0, &p2)) return {};
    q2 = a * q1 + q0;
    if (p2 > largest_numerator || q2 > largest_denominator) return {};
    p0 = p1, q0 = q1, p1 = p2, q1 = q2;
    if (std::abs(double(p1) / double(q1) - x) <= distance) {
      const auto decimal = q1 > simple ? to_decimal_fraction(x, distance) : std::nullopt;
      return decimal ? *decimal : Fraction{p1, q1};
    }
    rest = 1.0 / (rest - whole);
  }
  return {};
}

/// The greatest common divisor of two times; nothing if it needs integers beyond 64 bits.
[[maybe_unused]] static std::optional<Fraction> common_divisor(Fraction a, Fraction b) {
  if (a.numerator == 0) return b;
  if (b.numerator == 0) return a;
  __extension__ using Wide = __int128;
  const int64_t shared = std::gcd(a.denominator, b.denominator);
  const Wide denominator = Wide(a.denominator) * (b.denominator / shared);
  Wide x = Wide(a.numerator) * (denominator / a.denominator),
       y = Wide(b.numerator) * (denominator / b.denominator);
  while (y != 0) {
    const Wide rest = x % y;
    x = y, y = rest;
  }
  Wide numerator = x, reduced = denominator;
  for (Wide u = numerator, v = reduced;;) {
    if (v == 0) {
      numerator /= u, reduced /= u;
      break;
    }
    const Wide rest = u % v;
    u = v, v = rest;
  }
  if (numerator > INT64_MAX || reduced > INT64_MAX / 4) return {};
  return Fraction{int64_t(numerator), int64_t(reduced)};
}

/// time / base if it is an integer.
[[maybe_unused]] static std::optional<int64_t> whole_ratio(Fraction time, Fraction base) {
  __extension__ using Wide = __int128;
  const Wide above = Wide(time.numerator) * base.denominator, below = Wide(time.denominator) * base.numerator;
  if (below == 0 || above % below != 0 || above / below > INT64_MAX) return {};
  return int64_t(above / below);
}

}  // namespace loopwright
