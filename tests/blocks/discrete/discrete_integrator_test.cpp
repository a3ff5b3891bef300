#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::discrete_integrator_test {
namespace {

constexpr double sample_time = 0.1;
double u_at(int k) { return k < 0 ? 0.0 : std::cos(0.8 * k) + 0.2; }

struct Case {
  const char* method;
  double past, present;  // weights of u[k-1] and u[k]
};
constexpr Case cases[] = {{"forward", 0.1, 0}, {"backward", 0, 0.1}, {"trapezoidal", 0.05, 0.05}};

TEST(DiscreteIntegrator, FollowsItsRule) {
  for (const Case& c : cases) {
    BlockUnderTest block("DiscreteIntegrator",
                         R"({"initial": 2, "method": ")" + std::string(c.method) + "\"}", sample_time);
    double y = 2;
    for (int k = 0; k < 50; ++k) {
      y += c.past * u_at(k - 1) + c.present * u_at(k);
      EXPECT_NEAR(block.sample("u", u_at(k), "y"), y, 1e-14) << c.method << " " << k;
      EXPECT_NEAR(block.output("before"), y - c.present * u_at(k), 1e-14);
    }
  }
}

TEST(DiscreteIntegrator, IsHeldInsideItsLimitsSampleBySample) {
  for (const Case& c : cases) {
    BlockUnderTest block("DiscreteIntegrator",
                         R"({"low": -0.1, "high": 0.15, "method": ")" + std::string(c.method) + "\"}",
                         sample_time);
    double y = 0;
    int limited = 0;
    for (int k = 0; k < 80; ++k) {
      const double free = y + c.past * u_at(k - 1) + c.present * u_at(k);
      y = std::clamp(free, -0.1, 0.15);
      limited += y != free;
      EXPECT_NEAR(block.sample("u", u_at(k), "y"), y, 1e-14) << c.method << " " << k;
      EXPECT_LE(std::abs(block.output("before") - 0.025), 0.125);
    }
    EXPECT_GT(limited, 5);
  }
}

TEST(DiscreteIntegrator, IsResetWhenTheTriggerRises) {
  for (const Case& c : cases) {
    BlockUnderTest block("DiscreteIntegrator", R"({"method": ")" + std::string(c.method) + "\"}",
                         sample_time);
    const bool late = c.present == 0;
    block.input("reset_value") = 7;
    std::vector<double> y;
    for (int k = 0; k < 8; ++k) {
      block.input("reset") = k == 3 || k == 4 ? 1 : -1;
      y.push_back(block.sample("u", 1, "y"));
    }
    const size_t set = late ? 4 : 3;
    EXPECT_LT(y[set - 1], 1);
    EXPECT_EQ(y[set], 7);
    EXPECT_NEAR(y[set + 1], 7.1, 1e-14) << "a trigger that stays high resets once";
    EXPECT_NEAR(y[set + 3], 7.3, 1e-14);
  }
}

TEST(DiscreteIntegrator, BeforeNeedsNoPresentInput) {
  BlockUnderTest block("DiscreteIntegrator", "{}", sample_time);
  EXPECT_EQ(block.info().outputs[1].name, "before");
  EXPECT_EQ(block.info().outputs[1].fed_by, 0u);
}

TEST(DiscreteIntegrator, RefusesAnInitialValueOutsideItsLimits) {
  EXPECT_THAT(BlockUnderTest("DiscreteIntegrator", R"({"initial": 3, "high": 2})", 0.1).problems().text(),
              testing::HasSubstr("/initial"));
  EXPECT_THAT(BlockUnderTest("DiscreteIntegrator", R"({"method": "euler"})", 0.1).problems().text(),
              testing::HasSubstr("forward"));
}

}  // namespace
}  // namespace loopwright::discrete_integrator_test
