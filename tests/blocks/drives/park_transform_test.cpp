#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::park_transform_test {
namespace {

TEST(ParkTransform, AmplitudesAreKept) {
  BlockUnderTest park("ParkTransform");
  for (double angle : {0.0, 0.4, 2.0, -3.0, 40.0})
    for (double lead : {0.0, 0.7, -2.0}) {  // of the phases before the rotor
      const double common = 0.3;
      park.input("a") = 5 * std::cos(angle + lead) + common;
      park.input("b") = 5 * std::cos(angle + lead - 2 * pi / 3) + common;
      park.input("c") = 5 * std::cos(angle + lead + 2 * pi / 3) + common;
      park.input("angle") = angle;
      park.evaluate();
      EXPECT_NEAR(park.output("d"), 5 * std::cos(lead), 1e-13);
      EXPECT_NEAR(park.output("q"), 5 * std::sin(lead), 1e-13);
    }
}

}  // namespace
}  // namespace loopwright::park_transform_test
