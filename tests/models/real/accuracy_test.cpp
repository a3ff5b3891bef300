#include <gtest/gtest.h>
#include <cfloat>
#include "tests/models/real/arguments.h"

// The reference is libm in long double, which must be more accurate than double for these tests to be valid.
static_assert(LDBL_MANT_DIG >= 64);

namespace loopwright::test::accuracy_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr int samples = 300000;

/// |y - reference| in units in the last place of the reference. Infinity counts as 2¹⁰²⁴, the value after the
/// largest double. NaN against a number is an infinite error.
double error_in_ulp(double y, long double reference) {
  if (std::isnan(y) || std::isnan(reference)) return std::isnan(y) && std::isnan(reference) ? 0.0 : infinity;
  const long double end = 0x1p1024L;
  const long double expected = std::min(std::max(reference, -end), end);
  const long double found = std::isinf(y) ? std::copysign(end, (long double)y) : y;
  const double below = std::min(double(std::fabs(expected)), std::numeric_limits<double>::max());
  const long double ulp = below == std::numeric_limits<double>::max()
                              ? 0x1p971L
                              : (long double)std::nextafter(below, infinity) - (long double)below;
  return double(std::fabs(found - expected) / ulp);
}

/// The largest error and its argument.
struct Worst {
  double error = 0, at = 0, beside = 0;
  void see(double y, long double reference, double x, double second = 0) {
    if (const double e = error_in_ulp(y, reference); e > error) *this = {e, x, second};
  }
  void see_bounded(double y, long double reference, double bound, double x, double second) {
    if (const double e = error_in_ulp(y, reference) / bound; e > error) *this = {e, x, second};
  }
};
std::ostream& operator<<(std::ostream& out, const Worst& worst) {
  return out << worst.error << " at " << in_hexadecimal(worst.at) << ", " << in_hexadecimal(worst.beside);
}

template <class Function, class Reference>
Worst worst_between(double low, double high, const Function& f, const Reference& reference) {
  std::mt19937_64 generator(11);
  Worst worst;
  for (int i = 0; i < samples; ++i) {
    const double x = uniform(generator, low, high);
    worst.see(f(x), reference((long double)x), x);
  }
  return worst;
}
/// Over all special arguments and over random bit patterns.
template <class Function, class Reference>
Worst worst_anywhere(const Function& f, const Reference& reference, double limit = infinity) {
  Worst worst;
  for (const double x : arguments(samples, 12)) {
    if (!(std::fabs(x) > limit)) worst.see(f(x), reference((long double)x), x);
  }
  return worst;
}

const auto own_sine = [](double x) { return sine(x); };
const auto own_cosine = [](double x) { return cosine(x); };
const auto own_tangent = [](double x) { return hyperbolic_tangent(x); };
const auto own_exponential = [](double x) { return exponential(x); };
const auto own_logarithm = [](double x) { return natural_logarithm(x); };
const auto own_arc_tangent = [](double x) { return arc_tangent(x); };
const auto true_sine = [](long double x) { return std::sin(x); };
const auto true_cosine = [](long double x) { return std::cos(x); };
const auto true_tangent = [](long double x) { return std::tanh(x); };
const auto true_exponential = [](long double x) { return std::exp(x); };
const auto true_logarithm = [](long double x) { return std::log(x); };
const auto true_arc_tangent = [](long double x) { return std::atan(x); };

TEST(Sine, IsWithin3UlpUpToAMillionRadians) {
  for (const double limit : {2.0, 300.0, 1e6}) {
    const Worst worst = worst_between(-limit, limit, own_sine, true_sine);
    EXPECT_LE(worst.error, 3.0) << worst;
  }
  const Worst worst = worst_anywhere(own_sine, true_sine, 1e6);
  EXPECT_LE(worst.error, 3.0) << worst;
}
TEST(Cosine, IsWithin3UlpUpToAMillionRadians) {
  for (const double limit : {2.0, 300.0, 1e6}) {
    const Worst worst = worst_between(-limit, limit, own_cosine, true_cosine);
    EXPECT_LE(worst.error, 3.0) << worst;
  }
  const Worst worst = worst_anywhere(own_cosine, true_cosine, 1e6);
  EXPECT_LE(worst.error, 3.0) << worst;
}
TEST(Sine, IsWithin3UlpNextToItsZerosAndThoseOfTheCosine) {
  Worst worst_sine, worst_cosine;
  for (int quarter = 1; quarter <= 636619; ++quarter) {
    const double zero = double(quarter * (M_PIl / 2));
    for (const double x : {zero, std::nextafter(zero, 0.0), std::nextafter(zero, infinity)}) {
      worst_sine.see(sine(x), std::sin((long double)x), x);
      worst_cosine.see(cosine(x), std::cos((long double)x), x);
    }
  }
  EXPECT_LE(worst_sine.error, 3.0) << worst_sine;
  EXPECT_LE(worst_cosine.error, 3.0) << worst_cosine;
}
TEST(Sine, IsWithin3UlpBeyondAMillionRadians) {
  Worst worst_sine, worst_cosine;
  const auto see = [&](double x) {
    if (!(std::fabs(x) > 1e6)) return;
    worst_sine.see(sine(x), std::sin((long double)x), x);
    worst_cosine.see(cosine(x), std::cos((long double)x), x);
    EXPECT_TRUE(same_bits(sine_cosine(x).sine, sine(x)) && same_bits(sine_cosine(x).cosine, cosine(x)));
  };
  for (const double x : arguments(samples, 13)) see(x);
  std::mt19937_64 generator(19);
  for (int i = 0; i < samples; ++i) see(std::ldexp(uniform(generator, 1, 2), 20 + int(generator() % 1004)));
  see(0x1.6ac5b262ca1ffp+849);  // of all doubles the nearest to a multiple of π/2 (J.-M. Muller, Elementary
                                // Functions)
  EXPECT_LE(worst_sine.error, 3.0) << worst_sine;
  EXPECT_LE(worst_cosine.error, 3.0) << worst_cosine;
}
TEST(Sine, IsOddAndTheCosineEvenToTheBit) {
  for (const double x : arguments(20000, 14)) {
    EXPECT_TRUE(same_bits(sine(-x), -sine(x))) << in_hexadecimal(x);
    EXPECT_TRUE(same_bits(cosine(-x), cosine(x))) << in_hexadecimal(x);
  }
}

TEST(Sine, ReachesOneAndNeverExceedsIt) {
  EXPECT_EQ(sine(M_PI_2), 1.0);
  EXPECT_EQ(sine(-M_PI_2), -1.0);
  EXPECT_EQ(cosine(M_PI), -1.0);
  std::mt19937_64 generator(18);
  for (int i = 0; i < samples; ++i) {
    const double near_peak = uniform(generator, -1e-7, 1e-7);
    EXPECT_LE(std::fabs(sine(near_peak + M_PI_2 * (1.0 + double(i % 1000) * 2.0))), 1.0) << near_peak;
    EXPECT_LE(std::fabs(cosine(near_peak)), 1.0) << near_peak;
  }
}

TEST(HyperbolicTangent, IsWithin2AndAHalfUlp) {
  for (const double limit : {0.15, 0.6, 25.0}) {
    const Worst worst = worst_between(-limit, limit, own_tangent, true_tangent);
    EXPECT_LE(worst.error, 2.5) << worst;
  }
  const Worst worst = worst_anywhere(own_tangent, true_tangent);
  EXPECT_LE(worst.error, 2.5) << worst;
}

TEST(Exponential, IsWithin2UlpFromDenormalToOverflow) {
  for (const double limit : {1.0, 50.0, 760.0}) {
    const Worst worst = worst_between(-limit, limit, own_exponential, true_exponential);
    EXPECT_LE(worst.error, 2.0) << worst;
  }
  for (const auto& [low, high] : {std::pair{-746.0, -708.0}, {709.7, 709.8}}) {
    const Worst worst = worst_between(low, high, own_exponential, true_exponential);
    EXPECT_LE(worst.error, 2.0) << worst;
  }
  const Worst worst = worst_anywhere(own_exponential, true_exponential);
  EXPECT_LE(worst.error, 2.0) << worst;
}

TEST(NaturalLogarithm, IsWithin2UlpDenormalArgumentsIncluded) {
  for (const double limit : {0x1p-1022, 1.0, 2.0, 1e300}) {
    const Worst worst = worst_between(0.0, limit, own_logarithm, true_logarithm);
    EXPECT_LE(worst.error, 2.0) << worst;
  }
  const Worst near_one = worst_between(0.999, 1.001, own_logarithm, true_logarithm);
  EXPECT_LE(near_one.error, 2.0) << near_one;
  const Worst worst = worst_anywhere(own_logarithm, true_logarithm);
  EXPECT_LE(worst.error, 2.0) << worst;
}

TEST(ArcTangent, IsWithin3Ulp) {
  for (const double limit : {0.5, 1.0, 3.0}) {
    const Worst worst = worst_between(-limit, limit, own_arc_tangent, true_arc_tangent);
    EXPECT_LE(worst.error, 3.0) << worst;
  }
  const Worst worst = worst_anywhere(own_arc_tangent, true_arc_tangent);
  EXPECT_LE(worst.error, 3.0) << worst;
}

TEST(ArcTangent2, IsWithin3UlpInEveryQuadrantAndAtEveryCorner) {
  Worst worst;
  const auto y = arguments(samples, 15), x = arguments(samples, 16), special = special_arguments();
  for (std::size_t i = 0; i < y.size(); ++i) {
    worst.see(arc_tangent2(y[i], x[i]), std::atan2((long double)y[i], (long double)x[i]), y[i], x[i]);
  }
  for (const double a : special) {
    for (const double b : special) {
      const double angle = arc_tangent2(a, b);
      worst.see(angle, std::atan2((long double)a, (long double)b), a, b);
      EXPECT_TRUE(std::isnan(angle) || std::signbit(angle) == std::signbit(a));
    }
  }
  EXPECT_LE(worst.error, 3.0) << worst;
}

TEST(Power, IsWithinItsStatedBound) {
  std::mt19937_64 generator(17);
  Worst worst;  // relative to the bound
  const auto see = [&](double x, double y) {
    const double bound = 2.0 + std::min(std::fabs(y * std::log(x)), 750.0) / 20.0;
    worst.see_bounded(power(x, y), std::pow((long double)x, (long double)y), bound, x, y);
  };
  for (int i = 0; i < samples; ++i) {
    const double x = i % 2 ? std::ldexp(uniform(generator, 1, 2), int(generator() % 2040) - 1020)
                           : uniform(generator, 0.5, 2);
    see(x, uniform(generator, -745, 710) / std::log(x));
    see(x, uniform(generator, -4, 4));
  }
  EXPECT_LE(worst.error, 1.0) << worst;
}
TEST(Power, FollowsLibmAtItsCorners) {
  for (const double x : special_arguments()) {
    for (const double y : special_arguments()) {
      if (std::isnan(x) || std::isnan(y)) {
        EXPECT_TRUE(std::isnan(power(x, y)));
      } else if (x < 0.0) {
        EXPECT_TRUE(std::isnan(power(x, y)));
      } else {
        const long double expected = std::pow(std::fabs((long double)x), (long double)y);
        const double size =
            x > 0.0 && x < infinity && x != 1.0 ? std::fabs(double(y * std::log((long double)x))) : 0.0;
        const double bound = 2.0 + std::min(size, 750.0) / 20.0;
        EXPECT_LE(error_in_ulp(power(x, y), expected), bound)
            << in_hexadecimal(x) << " to the " << in_hexadecimal(y);
      }
    }
  }
}

TEST(ElementaryFunctions, GiveNaNForNaNAndLibmsValuesAtInfinityAndZero) {
  for_each_unary([](const char* name, const auto& f) { EXPECT_TRUE(std::isnan(f(nan))) << name; });
  for_each_binary([](const char* name, const auto& f) {
    if (std::string(name) == "select") return;
    EXPECT_TRUE(std::isnan(f(nan, 1.0)) && (std::isnan(f(1.0, nan)) || std::string(name) == "flip_sign"))
        << name;
  });
  for (const double x : {0.0, -0.0, infinity, -infinity, 0x1p-1074, -0x1p-1074, 0x1p-1022, -0x1p-1022}) {
    EXPECT_TRUE(same_bits(sine(x), std::sin(x))) << x;
    EXPECT_TRUE(same_bits(cosine(x), std::cos(x))) << x;
    EXPECT_TRUE(same_bits(hyperbolic_tangent(x), std::tanh(x))) << x;
    EXPECT_TRUE(same_bits(exponential(x), std::exp(x))) << x;
    EXPECT_TRUE(same_bits(arc_tangent(x), std::atan(x))) << x;
    EXPECT_LE(error_in_ulp(natural_logarithm(x), std::log((long double)x)), 2.0) << x;
  }
}

}  // namespace
}  // namespace loopwright::test::accuracy_test
