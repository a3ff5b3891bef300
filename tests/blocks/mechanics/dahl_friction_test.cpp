#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::dahl_friction_test {

TEST(DahlFriction, ApproachesItsLevelExponentiallyInDistance) {
  BlockUnderTest friction("DahlFriction", R"({"level": 20, "transition_distance": 1e-3})");
  double before = 0, distance = 0;  // fraction at the last reversal, distance since
  for (double velocity : {0.01, -0.05, 0.02}) {
    friction.input("velocity") = velocity;
    friction.advance(0.1, 2000);
    distance = 0.1 * std::abs(velocity) / 1e-3;
    const double towards = velocity > 0 ? 1 : -1;
    before = towards + (before - towards) * std::exp(-distance);
    friction.evaluate();
    EXPECT_NEAR(friction.output("fraction"), before, 1e-9);
    EXPECT_NEAR(friction.output("force"), 20 * before, 2e-8);
  }
}

TEST(DahlFriction, DependsOnThePathAndNotOnTheSpeed) {
  BlockUnderTest slow("DahlFriction", R"({"level": 20, "transition_distance": 1e-3})");
  BlockUnderTest fast("DahlFriction", R"({"level": 20, "transition_distance": 1e-3})");
  slow.input("velocity") = 0.001, fast.input("velocity") = 0.1;
  slow.advance(1.0, 1000), fast.advance(0.01, 1000);
  EXPECT_NEAR(slow.state("fraction"), fast.state("fraction"), 1e-10);
}

}  // namespace loopwright::dahl_friction_test
