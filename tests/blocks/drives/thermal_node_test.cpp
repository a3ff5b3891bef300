#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::thermal_node_test {
namespace {

TEST(ThermalNode, WarmsExponentiallyTowardsItsSteadyTemperature) {
  // T = T_s + P/G (1 - exp(-G t / C)), from the temperature of the surroundings
  BlockUnderTest node("ThermalNode", R"({"capacity": 400, "conductance": 0.8, "initial": 290})");
  node.input("heat") = 20, node.input("surroundings") = 290;
  node.advance(300, 300);
  node.evaluate();
  EXPECT_NEAR(node.output("temperature"), 290 + 25 * (1 - std::exp(-0.6)), 1e-9);
  EXPECT_NEAR(node.output("loss"), 20 * (1 - std::exp(-0.6)), 1e-9);
}

TEST(ThermalNode, KeepsItsHeatWithoutConductance) {
  BlockUnderTest node("ThermalNode", R"({"capacity": 50})");
  node.input("heat") = 10;
  node.advance(100, 10);
  node.evaluate();
  EXPECT_NEAR(node.output("temperature"), 293.15 + 20, 1e-9);
  EXPECT_EQ(node.output("loss"), 0);
}

TEST(ThermalNode, CoolsToSurroundingsThatAreNotWired) {
  BlockUnderTest node("ThermalNode", R"({"capacity": 10, "conductance": 1, "initial": 350})");
  node.advance(400, 400);
  node.evaluate();
  EXPECT_NEAR(node.output("temperature"), 293.15, 1e-9);
}

}  // namespace
}  // namespace loopwright::thermal_node_test
