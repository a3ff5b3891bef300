// Every comparison with NaN is false. A block that decides by one must stop instead.
#include <gmock/gmock.h>
#include <limits>
#include "tests/blocks/block_under_test.h"

namespace loopwright::nan_test {
namespace {

struct Case {
  const char *type, *settings, *input;
};

TEST(DecisionsOnNaN, StopTheRun) {
  const Case cases[] = {
      {"Comparison", R"({"operator": ">"})", "a"},
      {"Comparison", R"({"operator": "<="})", "b"},
      {"Switch", "{}", "control"},
      {"Relay", R"({"switch_on": 1, "switch_off": 0})", "u"},
      {"Sign", "{}", "u"},
      {"Integrator", "{}", "reset"},
      {"EndStop", R"({"high": 1, "stiffness": 10})", "position"},
      {"EndStop", R"({"high": 1, "stiffness": 10})", "velocity"},
      {"BacklashCoupling", R"({"gap": 1, "stiffness": 10})", "load_position"},
      {"Gear", R"({"ratio": 2, "gap": 1, "stiffness": 10})", "input_angle"},
      {"BallScrew", R"({"lead": 2, "gap": 1, "stiffness": 10})", "position"},
      {"CoulombFriction", R"({"level": 2, "mass": 1})", "velocity"},
      {"CoulombFriction", R"({"level": 2, "mass": 1})", "applied"},
      {"StribeckFriction", R"({"level": 2, "static_level": 3, "stribeck_speed": 1, "mass": 1})", "velocity"},
      {"DirectionDependentFriction", R"({"damping_forward": 2, "damping_backward": 1})", "velocity"},
      {"Pwm", R"({"bus": 2, "frequency": 10})", "command"},
      {"Pwm", R"({"bus": 2, "frequency": 10})", "current"},
      {"IncrementalEncoder", R"({"resolution": 1})", "position"},
  };
  for (const Case& c : cases) {
    BlockUnderTest block(c.type, c.settings);
    ASSERT_FALSE(block.problems().has_errors()) << c.type << block.problems().text();
    block.decide();
    EXPECT_EQ(block.fault(), "") << c.type << "." << c.input;
    block.input(c.input) = std::numeric_limits<double>::quiet_NaN();
    block.decide();
    EXPECT_THAT(std::string(block.fault()), testing::HasSubstr("NaN")) << c.type << "." << c.input;
  }
}

TEST(DecisionsOnNaN, StopADiscreteIntegratorAtItsSample) {
  BlockUnderTest block("DiscreteIntegrator", "{}", 0.1);
  block.input("reset") = std::numeric_limits<double>::quiet_NaN();
  block.update();
  EXPECT_THAT(std::string(block.fault()), testing::HasSubstr("NaN"));
}

}  // namespace
}  // namespace loopwright::nan_test
