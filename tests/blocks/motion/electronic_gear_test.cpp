#include <gmock/gmock.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::electronic_gear_test {
namespace {

constexpr double T = 0.001;

TEST(ElectronicGear, FollowsInAnExactRatioForALongTime) {
  BlockUnderTest gear("ElectronicGear", R"({"numerator": 17, "denominator": 23, "initial": 2})", T);
  ASSERT_FALSE(gear.problems().has_errors()) << gear.problems().text();
  gear.input("engage") = 1;
  const auto master = [](int k) { return 5 + 0.1 * k + std::sin(0.01 * k); };
  for (int k = 0; k < 200000; ++k) {
    gear.input("master") = master(k);
    gear.evaluate(k * T, k);
    if (k % 1000 == 0) {
      EXPECT_NEAR(gear.output("position"), 2 + 17.0 / 23 * (master(k) - master(0)), 1e-11) << k;
    }
    if (k > 0) {
      EXPECT_NEAR(gear.output("velocity"), 17.0 / 23 * (master(k) - master(k - 1)) / T, 1e-8);
    }
    gear.update();
  }
}

TEST(ElectronicGear, IsEngagedAndReleasedWithoutAJumpOfTheVelocity) {
  BlockUnderTest gear("ElectronicGear", R"({"numerator": 2, "ramp_time": 0.1})", T);
  double last = 0, at_full = 0, engaged_at = -1;
  for (int k = 0; k < 1000; ++k) {
    gear.input("master") = 3.0 * k * T;  // 3 per second
    gear.input("engage") = k >= 200 && k < 700;
    gear.evaluate(k * T, k);
    const double velocity = gear.output("velocity");
    EXPECT_LE(std::abs(velocity - last), 6 * T / 0.1 + 1e-9) << k;
    if (gear.output("engaged") == 1 && engaged_at < 0) engaged_at = k, at_full = gear.output("position");
    if (k == 650) {
      EXPECT_NEAR(velocity, 6, 1e-9);
    }
    if (k == 150 || k == 900) {
      EXPECT_NEAR(velocity, 0, 1e-9);
    }
    last = velocity;
    gear.update();
  }
  EXPECT_EQ(engaged_at, 299);
  EXPECT_NEAR(at_full, 6 * 0.1 / 2, 1e-9) << "the area below the ramp";
  EXPECT_NEAR(gear.output("position"), 6 * 0.5, 1e-9) << "both ramps together: half a second at full speed";
}

TEST(ElectronicGear, AResetSetsTheSlaveAndFollowsOn) {
  BlockUnderTest gear("ElectronicGear", R"({"numerator": 2})", T);
  gear.input("engage") = 1;
  for (int k = 0; k < 10; ++k) {
    gear.input("master") = k, gear.input("reset") = k == 5, gear.input("reset_value") = 100;
    gear.evaluate(k * T, k);
    EXPECT_NEAR(gear.output("position"), k < 5 ? 2 * k : 100 + 2 * (k - 5), 1e-12) << k;
    EXPECT_NEAR(gear.output("velocity"), k == 0 ? 0 : 2 / T, 1e-8);
    gear.update();
  }
}

TEST(ElectronicGear, RefusesADenominatorOfZero) {
  EXPECT_THAT(BlockUnderTest("ElectronicGear", R"({"numerator": 1, "denominator": 0})", T).problems().text(),
              testing::HasSubstr("the denominator is zero"));
}

}  // namespace
}  // namespace loopwright::electronic_gear_test
