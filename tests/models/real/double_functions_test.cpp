#include "models/real/double_functions.h"
#include <gtest/gtest.h>
#include "tests/models/real/arguments.h"

// The reference is libm in long double.

namespace loopwright::test::double_functions_test {
namespace {

constexpr int samples = 100000;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Case {
  const char* name;
  double (*own)(double);
  long double (*reference)(long double);
  double bound;  // ulp
  double low, high;
};

const Case cases[] = {
    {"tangent", tangent, tanl, 4, -1000, 1000},
    {"tangent near zero", tangent, tanl, 4, -1e-5, 1e-5},
    {"arc_sine", arc_sine, asinl, 3, -1, 1},
    {"arc_cosine", arc_cosine, acosl, 3, -1, 1},
    {"arc_cosine near one", arc_cosine, acosl, 3, 1 - 1e-9, 1},
    {"exponential_less_one", exponential_less_one, expm1l, 2, -50, 50},
    {"exponential_less_one near zero", exponential_less_one, expm1l, 2, -1e-9, 1e-9},
    {"logarithm_of_one_plus", logarithm_of_one_plus, log1pl, 3, -1, 10},
    {"logarithm_of_one_plus near zero", logarithm_of_one_plus, log1pl, 3, -1e-9, 1e-9},
    {"hyperbolic_sine", hyperbolic_sine, sinhl, 3, -3, 3},
    {"hyperbolic_sine of much", hyperbolic_sine, sinhl, 3, -710, 710},
    {"hyperbolic_cosine", hyperbolic_cosine, coshl, 4, -3, 3},
    {"hyperbolic_cosine of much", hyperbolic_cosine, coshl, 4, -710, 710},
    {"area_sine", area_sine, asinhl, 3, -10, 10},
    {"area_sine of much", area_sine, asinhl, 3, -1e300, 1e300},
    {"area_cosine", area_cosine, acoshl, 3, 1, 10},
    {"area_cosine near one", area_cosine, acoshl, 3, 1, 1 + 1e-9},
    {"area_cosine of much", area_cosine, acoshl, 3, 1, 1e300},
    {"area_tangent", area_tangent, atanhl, 3, -1, 1},
    {"binary_logarithm", binary_logarithm, log2l, 1, 0, 10},
    {"binary_logarithm of much", binary_logarithm, log2l, 1, 0, 1e300},
    {"decimal_logarithm", decimal_logarithm, log10l, 1, 0, 10},
    {"decimal_logarithm of little", decimal_logarithm, log10l, 1, 0, 1e-300},
};

/// |y - reference| in units in the last place of the reference.
double error_in_ulp(double y, long double reference) {
  if (std::isnan(y) || std::isnan(double(reference)))
    return std::isnan(y) == std::isnan(double(reference)) ? 0 : infinity;
  const double nearest = std::fabs(double(reference));
  return double(std::fabs(y - reference)) / (std::nextafter(nearest, infinity) - nearest);
}

TEST(DoubleFunctions, KeepTheirBounds) {
  for (const Case& c : cases) {
    std::mt19937_64 generator(21);
    double worst = 0, at = 0;
    for (int i = 0; i < samples; ++i) {
      const double x = uniform(generator, c.low, c.high);
      if (const double e = error_in_ulp(c.own(x), c.reference(x)); !(e <= worst)) worst = e, at = x;
    }
    EXPECT_LE(worst, c.bound) << c.name << " at " << in_hexadecimal(at);
  }
}

TEST(DoubleFunctions, GiveWhatLibmGivesAtTheEndsOfTheirDomains) {
  for (const Case& c : cases)
    for (const double x : {0.0, -0.0, 1.0, -1.0, 2.0, -2.0, infinity, -infinity, std::nan("")}) {
      const double expected = double(c.reference(x)), found = c.own(x);
      EXPECT_EQ(std::isnan(found), std::isnan(expected)) << c.name << " of " << x << ": " << found;
      if (std::isinf(expected) || std::isinf(found)) {
        EXPECT_EQ(found, expected) << c.name << " of " << x;
      }
    }
}

TEST(Logarithms, OfWholePowersAreWhole) {
  for (int k = -1074; k <= 1023; ++k) EXPECT_EQ(binary_logarithm(std::ldexp(1.0, k)), k);
  for (int k = -307; k <= 308; ++k) EXPECT_EQ(decimal_logarithm(std::stod("1e" + std::to_string(k))), k);
}

TEST(AnyPower, IsCorrectlyRoundedForWholeExponents) {
  std::mt19937_64 generator(22);
  for (const int exponent : {1, 2, 3, 4, 7, 20, 64, -1, -2, -3, -20, -64}) {
    double worst = 0;
    for (int i = 0; i < samples; ++i) {
      const double x = std::ldexp(uniform(generator, -2, 2), int(generator() % 12) - 6);
      const long double reference = std::pow((long double)x, exponent);
      const bool is_far_from_overflow = std::fabs(reference) > 1e-280L && std::fabs(reference) < 1e280L;
      if (is_far_from_overflow) worst = std::max(worst, error_in_ulp(any_power(x, exponent), reference));
    }
    EXPECT_LE(worst, 0.51) << exponent;
  }
  for (int k = -64; k <= 64; ++k) EXPECT_EQ(any_power(10, k), std::stod("1e" + std::to_string(k)));
}

TEST(AnyPower, IsThatOfLibmWhereItIsNoNumberOrInfinite) {
  const double values[] = {0.0,  -0.0, 0.5,  -0.5,  1.0,    -1.0,   2.0,
                           -2.0, 3.0,  -3.0, 1e200, -1e200, 1e-200, 1.0 / 3};
  for (const double x : values)
    for (const double y : values) {
      const double expected = std::pow(x, y), found = any_power(x, y);
      EXPECT_EQ(std::isnan(found), std::isnan(expected)) << x << "^" << y;
      if (std::isinf(expected)) {
        EXPECT_EQ(std::fabs(found), infinity) << x << "^" << y;
      } else if (!std::isnan(expected)) {
        EXPECT_NEAR(found, expected, 1e-13 * std::fabs(expected)) << x << "^" << y;
      }
    }
}

}  // namespace
}  // namespace loopwright::test::double_functions_test
