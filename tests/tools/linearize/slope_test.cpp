#include "tools/linearize/slope.h"
#include <gtest/gtest.h>
#include <cmath>

namespace loopwright::slope_test {
namespace {

Slope slope_of(double (*f)(double), double x) {
  return slope(
      [&](double at, std::span<double> value) {
        value[0] = f(at);
        return std::isfinite(value[0]);
      },
      x, 1);
}

TEST(Slope, AStraightLineHasItsSlopeToTheLastBits) {
  for (double x : {0.0, 1e-6, 0.3, -2.0, 4e5})
    EXPECT_NEAR(slope_of([](double u) { return 4056.6 * u - 3; }, x).value[0], 4056.6, 4056.6 * 1e-14) << x;
}

TEST(Slope, SmoothFunctionsOfAnyScaleAreGoodToTenDigits) {
  const auto cogging = [](double u) { return 0.76 * std::sin(2 * M_PI * u / 0.0225 + 0.4); };
  const auto slope_of_cogging = [](double u) {
    return 0.76 * 2 * M_PI / 0.0225 * std::cos(2 * M_PI * u / 0.0225 + 0.4);
  };
  for (double x : {0.0, 0.01, 0.3})
    EXPECT_NEAR(slope_of(cogging, x).value[0], slope_of_cogging(x), 200 * 1e-10) << x;
  EXPECT_NEAR(slope_of([](double u) { return std::exp(u / 1e3); }, 2e3).value[0], 1e-3 * std::exp(2), 1e-12);
  EXPECT_NEAR(slope_of([](double u) { return std::tanh(u / 1e-5); }, 1e-6).value[0],
              1e5 / std::pow(std::cosh(0.1), 2), 1e5 * 1e-9);
}

TEST(Slope, APeriodThatDividesRoundNumbersMisleadsNobody) {
  EXPECT_NEAR(slope_of([](double u) { return std::sin(2 * M_PI * u * 8); }, 0).value[0], 16 * M_PI, 1e-8);
}

TEST(Slope, LimitsAndDeadZonesAtADistanceAreNotFelt) {
  EXPECT_EQ(slope_of([](double u) { return std::clamp(u, -0.01, 0.01); }, 0).value[0], 1);
  EXPECT_EQ(slope_of([](double u) { return std::clamp(u, -10.0, 10.0); }, 12).value[0], 0);
  EXPECT_EQ(slope_of([](double u) { return u > 0.001    ? u - 0.001
                                           : u < -0.001 ? u + 0.001
                                                        : 0; }, 0).value[0],
            0);
}

TEST(Slope, ACornerShowsBothOfItsSlopes) {
  const Slope corner = slope_of([](double u) { return std::max(2 * u, -u); }, 0);
  ASSERT_TRUE(corner.has_corner(0));
  EXPECT_NEAR(corner.left[0], -1, 1e-9);
  EXPECT_NEAR(corner.right[0], 2, 1e-9);
  EXPECT_NEAR(corner.value[0], 0.5, 1e-9);
  EXPECT_FALSE(slope_of([](double u) { return u * std::abs(u); }, 0).has_corner(0));
}

TEST(Slope, WhereThereIsNoValueOnOneSideThereIsNoSlope) {
  EXPECT_TRUE(std::isnan(slope_of([](double u) { return std::sqrt(u); }, 0).value[0]));
  EXPECT_NEAR(slope_of([](double u) { return std::log(u); }, 1e-3).value[0], 1e3, 1e-6);
}

}  // namespace
}  // namespace loopwright::slope_test
