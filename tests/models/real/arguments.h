/// Arguments for the tests of models/real, and a function's results over them, for double and for lanes.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <vector>
#include "models/real/functions.h"

namespace loopwright::test {

/// Equal in every bit, -0 different from 0. All NaN are equal.
inline bool same_bits(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) ||
         std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

inline std::string in_hexadecimal(double x) {
  char text[64];
  std::snprintf(text, sizeof text, "%a (%.17g)", x, x);
  return text;
}

/// Zeros, ones, halves, denormal, tiny, huge, infinite and NaN, each with both signs, and the neighbors of
/// branch points of functions.
inline std::vector<double> special_arguments() {
  using limits = std::numeric_limits<double>;
  std::vector<double> all;
  for (const double x : {0.0,
                         0.25,
                         0.5,
                         1.0,
                         1.5,
                         2.0,
                         2.5,
                         3.0,
                         22.0,
                         44.0,
                         54.0,
                         709.0,
                         709.782712893384,
                         710.0,
                         744.0,
                         745.1332191019411,
                         745.1332191019412,
                         746.0,
                         1e6,
                         1e22,
                         1e300,
                         0x1p51,
                         0x1p52,
                         0x1p53,
                         0x1p-1022,
                         0x1p-1074,
                         0x1p-1060,
                         1e-300,
                         1e-20,
                         1e-8,
                         M_PI_4,
                         M_PI_2,
                         M_PI,
                         M_SQRT2,
                         M_SQRT1_2,
                         M_SQRT2 + 1,
                         M_SQRT2 - 1,
                         limits::max(),
                         limits::infinity(),
                         limits::quiet_NaN()}) {
    for (const double y : {x, std::nextafter(x, 0.0), std::nextafter(x, limits::infinity())}) {
      all.push_back(y);
      all.push_back(-y);
    }
  }
  return all;
}

/// A uniform number in [low, high), the same on every machine.
inline double uniform(std::mt19937_64& generator, double low, double high) {
  return low + (high - low) * (0x1p-53 * double(generator() >> 11));
}

/// The special arguments, then thirds: any bit pattern, ±2^uniform(-60, 60), uniform(-50, 50).
inline std::vector<double> arguments(std::size_t random, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::vector<double> all = special_arguments();
  for (std::size_t i = 0; i < random; ++i) {
    const double sign = generator() & 1 ? -1.0 : 1.0;
    if (i % 3 == 0) all.push_back(std::bit_cast<double>(generator()));
    if (i % 3 == 1) all.push_back(sign * std::ldexp(uniform(generator, 1, 2), int(generator() % 121) - 60));
    if (i % 3 == 2) all.push_back(uniform(generator, -50, 50));
  }
  while (all.size() % 64 != 0) all.push_back(0.0);  // full registers of every vector width
  return all;
}

template <class Real> Real load(std::span<const double> values, std::size_t first) {
  Real x;
  for (int l = 0; l < lanes_of<Real>; ++l) set_lane(x, l, values[first + std::size_t(l)]);
  return x;
}

/// f(x) of every argument, lanes_of<Real> at a time.
template <class Real, class Function>
std::vector<double> results(const Function& f, std::span<const double> x) {
  std::vector<double> y;
  for (std::size_t i = 0; i < x.size(); i += lanes_of<Real>) {
    const Real value = f(load<Real>(x, i));
    for (int l = 0; l < lanes_of<Real>; ++l) y.push_back(lane(value, l));
  }
  return y;
}
template <class Real, class Function>
std::vector<double> results(const Function& f, std::span<const double> x, std::span<const double> y) {
  std::vector<double> z;
  for (std::size_t i = 0; i < x.size(); i += lanes_of<Real>) {
    const Real value = f(load<Real>(x, i), load<Real>(y, i));
    for (int l = 0; l < lanes_of<Real>; ++l) z.push_back(lane(value, l));
  }
  return z;
}

/// Calls visit(name, f) for every function of one argument.
template <class Visit> void for_each_unary(Visit&& visit) {
  visit("sine", [](const auto& x) { return sine(x); });
  visit("cosine", [](const auto& x) { return cosine(x); });
  visit("sine of sine_cosine", [](const auto& x) { return sine_cosine(x).sine; });
  visit("cosine of sine_cosine", [](const auto& x) { return sine_cosine(x).cosine; });
  visit("hyperbolic_tangent", [](const auto& x) { return hyperbolic_tangent(x); });
  visit("exponential", [](const auto& x) { return exponential(x); });
  visit("natural_logarithm", [](const auto& x) { return natural_logarithm(x); });
  visit("arc_tangent", [](const auto& x) { return arc_tangent(x); });
  visit("absolute", [](const auto& x) { return absolute(x); });
  visit("negative", [](const auto& x) { return -x; });
  visit("sign_of", [](const auto& x) { return sign_of(x); });
  visit("round_even", [](const auto& x) { return round_even(x); });
  visit("floor_of", [](const auto& x) { return floor_of(x); });
  visit("square_root", [](const auto& x) { return square_root(x); });
  visit("upper_half", [](const auto& x) { return upper_half(x); });
  visit("is_finite", [](const auto& x) { return select(is_finite(x), 1.0 + 0.0 * x, -1.0 + 0.0 * x); });
}

/// Calls visit(name, f) for every function of two arguments.
template <class Visit> void for_each_binary(Visit&& visit) {
  visit("+", [](const auto& x, const auto& y) { return x + y; });
  visit("-", [](const auto& x, const auto& y) { return x - y; });
  visit("*", [](const auto& x, const auto& y) { return x * y; });
  visit("/", [](const auto& x, const auto& y) { return x / y; });
  visit("maximum", [](const auto& x, const auto& y) { return maximum(x, y); });
  visit("minimum", [](const auto& x, const auto& y) { return minimum(x, y); });
  visit("flip_sign", [](const auto& x, const auto& y) { return flip_sign(x, y); });
  visit("power", [](const auto& x, const auto& y) { return power(x, y); });
  visit("arc_tangent2", [](const auto& x, const auto& y) { return arc_tangent2(x, y); });
  visit("select", [](const auto& x, const auto& y) {
    return select(((x < y) & !(x == y)) | (y >= 3.0) | ((x <= -y) & (x != 0.0)) | (x > 7.0), x, y);
  });
}

}  // namespace loopwright::test
