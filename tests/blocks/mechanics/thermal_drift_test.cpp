#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::thermal_drift_test {

TEST(ThermalDrift, GainGoesFromOneToItsWarmValue) {
  BlockUnderTest drift("ThermalDrift", R"({"drift": -0.08, "time_constant": 300})");
  drift.input("u") = 10;
  for (double t : {0.0, 300.0, 1e6}) {
    drift.evaluate(t);
    EXPECT_NEAR(drift.output("y"), 10 * (1 - 0.08 * (1 - std::exp(-t / 300))), 1e-13);
  }
}

TEST(ThermalDrift, IsColdUntilItBegins) {
  BlockUnderTest drift("ThermalDrift", R"({"drift": 0.5, "time_constant": 10, "start": 600})");
  drift.input("u") = 2;
  for (double t : {0.0, 599.0, 600.0, 610.0}) {
    drift.evaluate(t);
    EXPECT_NEAR(drift.output("y"), 2 * (1 + 0.5 * (1 - std::exp(-std::max(0.0, t - 600) / 10))), 1e-13);
  }
}

}  // namespace loopwright::thermal_drift_test
