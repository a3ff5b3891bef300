#include <gmock/gmock.h>
#include <random>
#include "tests/blocks/block_under_test.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::atan_2_test {
namespace {

TEST(Atan2, IsTheAngleOfAPoint) {
  BlockUnderTest block("Atan2");
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 10000; ++i) {
    const double x = normal(random), y = normal(random);
    block.input("x") = x, block.input("y") = y;
    block.evaluate();
    ASSERT_NEAR(block.output("angle"), double(atan2l(y, x)), 1e-15) << y << ", " << x;
  }
}

TEST(Atan2, TellsWhereItJumps) {
  BlockUnderTest block("Atan2");
  const auto side = [&](double y) {
    block.input("x") = -1, block.input("y") = y;
    block.crossings();
    return block.crossing("y") > 0;
  };
  EXPECT_NE(side(1e-12), side(-1e-12));
  EXPECT_EQ(side(0), side(1e-12)) << "as the angle, which is π there";
}

TEST(Atan2, StaysWithinHalfATurnInARun) {
  const RunResult result =
      run_of(diagram(R"("w": {"type": "Constant", "value": {"value": 7, "unit": "rad/s"}},
      "a": {"type": "Integrator", "in": {"u": "w.y"}}, "s": {"type": "Trigonometry", "function": "sin", "in": {"u": "a.y"}},
      "c": {"type": "Trigonometry", "function": "cos", "in": {"u": "a.y"}},
      "b": {"type": "Atan2", "in": {"y": "s.y", "x": "c.y"}})",
                     R"("method": "dopri5", "stop": 5, "record_step": 0.01)"));
  const auto &a = signal(result, "a.y"), &b = signal(result, "b.angle");
  for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(b[i], std::remainder(a[i], 2 * pi), 1e-9) << i;
}

}  // namespace
}  // namespace loopwright::atan_2_test
