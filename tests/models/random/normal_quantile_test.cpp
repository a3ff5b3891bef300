#include "models/random/normal_quantile.h"
#include <gtest/gtest.h>
#include <cmath>

namespace loopwright::normal_quantile_test {

TEST(NormalQuantile, IsTheInverseOfTheNormalDistribution) {
  for (int i = -3000; i <= 2500; ++i) {
    const long double p = std::erfc(-i * 1e-3L * 3 / std::sqrt(2.0L)) / 2;
    const double x = i * 3e-3, lost_in_p = i > 0 ? 1e-16 / std::exp(-x * x / 2) : 0;  // where p is close to 1
    EXPECT_NEAR(normal_quantile(double(p)), x, 1e-14 + 10 * lost_in_p) << i;
  }
}

TEST(NormalQuantile, IsOddAboutOneHalfAndReachesFar) {
  for (double p = 0x1p-20; p < 0.5; p *= 1.5) {
    const double q = std::ldexp(std::rint(std::ldexp(p, 40)), -40);  // 1 - q is exact
    EXPECT_EQ(normal_quantile(q), -normal_quantile(1 - q)) << q;
  }
  EXPECT_EQ(normal_quantile(0.5), 0);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-15 * 4);
  EXPECT_NEAR(normal_quantile(1e-300), -37.0470962994, 1e-9);
}

}  // namespace loopwright::normal_quantile_test
