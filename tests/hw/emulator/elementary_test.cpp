// The functions that the emulated motor and the hidden-effect generator use instead of those of the C
// library.
#include <gtest/gtest.h>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

extern "C" {
#include "hw/emulator/elementary.h"
}

namespace elementary_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The largest error between low and high, in units in the last place.
double worst(double (*own)(double), long double (*reference)(long double), double low, double high) {
  std::mt19937_64 generator(1);
  double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    const double x = low + (high - low) * 0x1p-53 * double(generator() >> 11);
    const long double expected = reference(x);
    const double size = std::fabs(double(expected));
    worst = std::max(worst, double(std::fabs(own(x) - expected)) / (std::nextafter(size, infinity) - size));
  }
  return worst;
}

TEST(Elementary, IsWithinThreeUlp) {
  for (const double limit : {1.0, 100.0, 1e6}) {
    EXPECT_LE(worst(sine_of, sinl, -limit, limit), 3);
    EXPECT_LE(worst(cosine_of, cosl, -limit, limit), 3);
  }
  for (const double limit : {1e-6, 0.3, 700.0}) EXPECT_LE(worst(exponential_of, expl, -limit, limit), 3);
  for (const double limit : {1e-6, 0.3, 30.0})
    EXPECT_LE(worst(hyperbolic_tangent_of, tanhl, -limit, limit), 3);
  for (const double limit : {1.0, 2.0, 1e6}) EXPECT_LE(worst(logarithm_of, logl, 0.5 / limit, limit), 3);
}

TEST(Elementary, SineAndCosineTogetherHaveTheBitsOfEach) {
  std::mt19937_64 generator(2);
  for (int i = 0; i < 200000; ++i) {
    const double x = std::ldexp(double(int64_t(generator())), int(generator() % 90) - 110);
    double sine, cosine;
    sine_and_cosine_of(x, &sine, &cosine);
    ASSERT_EQ(std::bit_cast<uint64_t>(sine), std::bit_cast<uint64_t>(sine_of(x))) << x;
    ASSERT_EQ(std::bit_cast<uint64_t>(cosine), std::bit_cast<uint64_t>(cosine_of(x))) << x;
  }
}

TEST(Elementary, TakesTheEndsOfItsDomains) {
  EXPECT_EQ(sine_of(0), 0);
  EXPECT_EQ(cosine_of(0), 1);
  EXPECT_EQ(exponential_of(0), 1);
  EXPECT_EQ(exponential_of(-infinity), 0);
  EXPECT_EQ(exponential_of(infinity), infinity);
  EXPECT_EQ(hyperbolic_tangent_of(infinity), 1);
  EXPECT_EQ(hyperbolic_tangent_of(-infinity), -1);
  EXPECT_EQ(logarithm_of(1), 0);
  EXPECT_EQ(logarithm_of(0), -infinity);
  EXPECT_EQ(power_of(0, 1.5), 0);
  EXPECT_EQ(power_of(1, 1.5), 1);
  EXPECT_TRUE(std::isnan(sine_of(infinity)) && std::isnan(hyperbolic_tangent_of(NAN)));
}

}  // namespace

}  // namespace elementary_test
