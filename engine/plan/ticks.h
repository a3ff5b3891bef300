/// Time as whole numbers: every sample time is a multiple of one base period, which is an exact fraction of a
/// second.
#pragma once
#include <cstdint>
#include <optional>

namespace loopwright {

/// A time in seconds as a fraction in lowest terms, both parts positive (numerator may be 0).
struct Fraction {
  int64_t numerator = 0, denominator = 1;
  double value() const { return double(numerator) / double(denominator); }
  bool operator==(const Fraction&) const = default;
};

/// The simplest fraction within a relative distance of 1e-12 of x >= 0: 0.001 is 1/1000, 1.0/3 is 1/3.
/// Nothing if x is not finite, negative, or needs more than nine digits above and below.
std::optional<Fraction> to_fraction(double x);

/// The greatest common divisor of two times; nothing if it needs numbers beyond 64 bits.
std::optional<Fraction> common_divisor(Fraction a, Fraction b);

/// time / base when that is whole.
std::optional<int64_t> whole_ratio(Fraction time, Fraction base);

/// The base period of a plan; time is tick · base, formed by one multiplication and one division, never
/// summed.
struct TickClock {
  Fraction base{1, 1000};
  double time(int64_t tick) const { return double(tick * base.numerator) / double(base.denominator); }
};

}  // namespace loopwright
