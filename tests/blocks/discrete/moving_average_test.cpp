#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::moving_average_test {
namespace {

TEST(MovingAverage, IsTheMeanOfTheLastSamples) {
  for (int n : {1, 2, 3, 7, 16}) {
    BlockUnderTest block("MovingAverage", R"({"initial": 2, "samples": )" + std::to_string(n) + "}", 0.01);
    std::vector<double> u;
    for (int k = 0; k < 100; ++k) {
      u.push_back(std::sin(1.7 * k));
      double sum = 0;
      for (int i = k - n + 1; i <= k; ++i) sum += i < 0 ? 2 : u[size_t(i)];
      EXPECT_NEAR(block.sample("u", u.back(), "y"), sum / n, 1e-14) << n << " samples at " << k;
    }
  }
}

TEST(MovingAverage, ForgetsAnOutlierToTheLastBit) {
  for (double outlier :
       {1e300, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    BlockUnderTest block("MovingAverage", R"({"samples": 5})", 0.01);
    block.sample("u", outlier, "y");
    for (int k = 1; k < 12; ++k) {
      const double y = block.sample("u", 3, "y");
      if (k >= 5) {
        EXPECT_EQ(y, 3) << k;
      } else {
        EXPECT_NE(y, 3) << k;
      }
    }
  }
}

TEST(MovingAverage, DoesNotDriftOverAMillionSamples) {
  BlockUnderTest block("MovingAverage", R"({"samples": 10})", 0.001);
  double y = 0;
  for (int k = 0; k < 1000000; ++k) y = block.sample("u", k % 10 == 0 ? 0.1 : 0.1 + 1e-3 * (k % 7), "y");
  double sum = 0;
  for (int k = 999990; k < 1000000; ++k) sum += k % 10 == 0 ? 0.1 : 0.1 + 1e-3 * (k % 7);
  EXPECT_NEAR(y, sum / 10, 1e-16);
}

}  // namespace
}  // namespace loopwright::moving_average_test
