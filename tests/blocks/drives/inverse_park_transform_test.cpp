#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::inverse_park_transform_test {
namespace {

TEST(InverseParkTransform, GivesThreePhasesAThirdOfATurnApart) {
  BlockUnderTest inverse("InverseParkTransform"), park("ParkTransform");
  for (double angle : {0.0, 0.4, 2.0, -3.0, 40.0}) {
    const double d = 3, q = -4;
    inverse.input("d") = d, inverse.input("q") = q, inverse.input("angle") = angle;
    inverse.evaluate();
    const char* const phases[] = {"a", "b", "c"};
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(inverse.output(phases[i]),
                  d * std::cos(angle - i * 2 * pi / 3) - q * std::sin(angle - i * 2 * pi / 3), 1e-13);
    for (const char* phase : phases) park.input(phase) = inverse.output(phase);
    park.input("angle") = angle;
    park.evaluate();
    EXPECT_NEAR(park.output("d"), d, 1e-13);
    EXPECT_NEAR(park.output("q"), q, 1e-13);
  }
}

}  // namespace
}  // namespace loopwright::inverse_park_transform_test
