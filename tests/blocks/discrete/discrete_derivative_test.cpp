#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::discrete_derivative_test {
namespace {

TEST(DiscreteDerivative, IsTheDifferenceOverTheSampleTime) {
  BlockUnderTest block("DiscreteDerivative", R"({"initial": 1})", 0.5);
  EXPECT_EQ(block.sample("u", 1, "y"), 0);
  EXPECT_EQ(block.sample("u", 4, "y"), 6);
  EXPECT_EQ(block.sample("u", 4, "y"), 0);
  EXPECT_EQ(block.sample("u", 3, "y"), -2);
  block.restart();
  EXPECT_EQ(block.sample("u", 0, "y"), -2);
}

}  // namespace
}  // namespace loopwright::discrete_derivative_test
