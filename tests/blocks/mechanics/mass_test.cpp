#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::mass_test {

TEST(Mass, MovesByNewtonsLawWithItsPayload) {
  BlockUnderTest mass("Mass", R"({"mass": 2, "payload": 3, "initial_position": 1, "initial_velocity": -1})");
  mass.input("force") = 10;
  mass.advance(2.0, 4);
  mass.evaluate(2.0);
  EXPECT_DOUBLE_EQ(mass.output("acceleration"), 2.0);
  EXPECT_DOUBLE_EQ(mass.output("velocity"), -1 + 2 * 2.0);
  EXPECT_DOUBLE_EQ(mass.output("position"), 1 - 2.0 + 0.5 * 2 * 4);
}

TEST(Mass, MustBePositive) {
  BlockUnderTest mass("Mass", R"({"mass": 0})");
  EXPECT_TRUE(mass.problems().has_errors());
}

}  // namespace loopwright::mass_test
