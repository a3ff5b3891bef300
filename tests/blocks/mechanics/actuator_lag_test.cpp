#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::actuator_lag_test {

TEST(ActuatorLag, StepResponseIsExponential) {
  BlockUnderTest lag("ActuatorLag", R"({"time_constant": 0.01, "initial": 1})");
  lag.input("command") = 5;
  lag.advance(0.02, 2000);
  EXPECT_NEAR(lag.state("force"), 5 - 4 * std::exp(-2.0), 1e-12);
}

TEST(ActuatorLag, CommandDoesNotFeedThrough) {
  BlockUnderTest lag("ActuatorLag", R"({"time_constant": 0.01})");
  EXPECT_EQ(lag.info().outputs.at(0).group, -1) << "it is a wire to the state";
  EXPECT_EQ(lag.info().outputs.at(0).state, 0);
}

}  // namespace loopwright::actuator_lag_test
