#include <gmock/gmock.h>
#include <random>
#include "tests/blocks/block_under_test.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::modulo_test {
namespace {

TEST(Modulo, IsTheRestOfADivision) {
  BlockUnderTest block("Modulo", R"({"divisor": 0.75, "low": -0.25})");
  for (int i = -400; i <= 400; ++i) {  // in sixteenths, where everything is exact
    block.input("u") = i / 16.0;
    block.evaluate();
    const int rest = ((i + 4) % 12 + 12) % 12 - 4;
    EXPECT_EQ(block.output("y"), rest / 16.0) << i;
  }
}

TEST(Modulo, StaysInItsRangeWhateverTheRounding) {
  std::mt19937_64 random(9);
  for (const double divisor : {0.1, 1.0 / 3, 2 * pi, 1e-5}) {
    BlockUnderTest block("Modulo",
                         fmt::format(R"({{"divisor": {:.17g}, "low": {:.17g}}})", divisor, -divisor / 2));
    for (int i = 0; i < 20000; ++i) {
      const double whole = double(random() % 2000) - 1000;
      const double u = std::nextafter((whole + 0.5) * divisor, random() % 2 ? 1e9 : -1e9);
      block.input("u") = u;
      block.evaluate();
      ASSERT_GE(block.output("y"), -divisor / 2 - 1e-12 * divisor) << u;
      ASSERT_LE(block.output("y"), divisor / 2 + 1e-12 * divisor) << u;
      ASSERT_NEAR(std::remainder(block.output("y") - u, divisor), 0, 1e-12 * std::fabs(u)) << u;
      block.crossings();
      ASSERT_TRUE(block.crossing("lower") > 0 && block.crossing("upper") < 0) << u;
    }
  }
}

TEST(Modulo, WrapsAnAngleAtExactInstants) {
  const RunResult result = run_of(
      diagram(R"("w": {"type": "Constant", "value": 5}, "a": {"type": "Integrator", "in": {"u": "w.y"}},
      "m": {"type": "Modulo", "divisor": 2, "in": {"u": "a.y"}}, "area": {"type": "Integrator", "in": {"u": "m.y"}})",
              R"("method": "dopri5", "stop": 4, "record_step": 1)"));
  EXPECT_NEAR(signal(result, "area.y").back(), 10 * 0.5 * 2 * 0.4, 1e-9)
      << "ten teeth of height 2 and length 0.4 s";
}

TEST(Modulo, StopsAtASignalThatIsTooLarge) {
  BlockUnderTest block("Modulo", R"({"divisor": 1e-9})");
  block.input("u") = 1e9;
  block.evaluate();
  EXPECT_EQ(block.fault(), "the signal is too large to have a rest");
}

}  // namespace
}  // namespace loopwright::modulo_test
