#include "engine/plan/ticks.h"
#include <cmath>
#include <numeric>

namespace loopwright {

std::optional<Fraction> to_fraction(double x) {
  if (!std::isfinite(x) || x < 0) return {};
  if (x == 0) return Fraction{0, 1};
  // Continued fraction: convergents p/q until one is near enough.
  int64_t p0 = 0, q0 = 1, p1 = 1, q1 = 0;
  double rest = x;
  for (int i = 0; i < 40; ++i) {
    const double whole = std::floor(rest);
    if (whole > 2e9) return {};
    const int64_t a = int64_t(whole);
    const int64_t p2 = a * p1 + p0, q2 = a * q1 + q0;
    if (p2 > 2'000'000'000 || q2 > 2'000'000'000) return {};
    p0 = p1, q0 = q1, p1 = p2, q1 = q2;
    if (std::abs(double(p1) / double(q1) - x) <= 1e-12 * x) return Fraction{p1, q1};
    rest = 1.0 / (rest - whole);
  }
  return {};
}

std::optional<Fraction> common_divisor(Fraction a, Fraction b) {
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

std::optional<int64_t> whole_ratio(Fraction time, Fraction base) {
  __extension__ using Wide = __int128;
  const Wide above = Wide(time.numerator) * base.denominator, below = Wide(time.denominator) * base.numerator;
  if (below == 0 || above % below != 0 || above / below > INT64_MAX) return {};
  return int64_t(above / below);
}

}  // namespace loopwright
