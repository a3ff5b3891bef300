#include <gtest/gtest.h>
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

}  // namespace loopwright::thermal_drift_test
