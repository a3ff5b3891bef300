#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::square_root_test {
namespace {

TEST(SquareRoot, IsTheNearestNumberToTheRoot) {
  BlockUnderTest block("SquareRoot");
  for (double u = 0; u < 1e6; u = 1.37 * u + 1e-6) {
    block.input("u") = u;
    block.evaluate();
    EXPECT_EQ(block.output("y"), std::sqrt(u));
  }
  EXPECT_EQ(block.fault(), "");
  block.input("u") = -1e-9;
  block.evaluate();
  EXPECT_EQ(block.fault(), "the square root of a number below 0");
}

TEST(SquareRoot, HasTheRootOfTheUnit) {
  const auto plan = plan_of(diagram(R"("c": {"type": "Constant", "value": {"value": 4, "unit": "m^2/s^2"}},
      "r": {"type": "SquareRoot", "in": {"u": "c.y"}})"));
  EXPECT_EQ(to_string(plan->unit_of(plan->find("r.y")[0]).value()), "m/s");
}

}  // namespace
}  // namespace loopwright::square_root_test
