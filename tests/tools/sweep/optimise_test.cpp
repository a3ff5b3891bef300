#include "tools/sweep/optimise.h"
#include <gmock/gmock.h>
#include "tests/tools/sweep/sweep_testing.h"

namespace loopwright::optimise_test {
namespace {

// (x - 0.3)² + (ln(y/20))², least at 0.3 and 20, greatest at a corner.
const char* const bowl = R"({"loopwright": 1, "solver": {"stop": 0.1, "step": 0.1}, "blocks": {
  "x": {"type": "Constant", "value": 0}, "y": {"type": "Constant", "value": 1},
  "z": {"type": "Expression", "formula": "(a - 0.3)^2 + ln(b/20)^2", "names": ["a", "b"], "in": {"arguments": ["x.y", "y.y"]}}}, "log": ["z.y"]})";
SweepFolder folder() {
  return SweepFolder(R"("x.value": {"values": [-1, 2]}, "y.value": {"log_uniform": {"from": 1, "to": 100}})",
                     R"(, "samples": {"count": 1})", R"("z": {"final": "z.y"})", bowl);
}

TEST(Optimise, FindsTheLeastValueInside) {
  const SweepFolder sweep = folder();
  const Optimum best = optimise(sweep.plan(), {.metric = "z"});
  ASSERT_TRUE(best.found);
  EXPECT_NEAR(best.point[0], 0.3, 1e-3);
  EXPECT_NEAR(best.point[1], 20, 0.05);
  EXPECT_LE(best.evaluations, 300);
}

TEST(Optimise, FindsTheWorstCaseAtACorner) {
  const SweepFolder sweep = folder();
  const Optimum worst = optimise(sweep.plan(), {.metric = "z", .maximise = true});
  EXPECT_NEAR(worst.point[0], 2, 0.02);
  EXPECT_NEAR(worst.point[1], 1, 0.02);
  EXPECT_EQ(worst.value, optimise(sweep.plan(), {.metric = "z", .maximise = true}).value);
}

TEST(Optimise, PairedAxesMoveTogether) {
  // (x - y + 1)² is 1 at all pairs with x = y; unpaired axes would reach 0.
  const char* const gap = R"({"loopwright": 1, "solver": {"stop": 0.1, "step": 0.1}, "blocks": {
    "x": {"type": "Constant", "value": 0}, "y": {"type": "Constant", "value": 1},
    "z": {"type": "Expression", "formula": "(a - b + 1)^2 + (a - 3)^2", "names": ["a", "b"],
          "in": {"arguments": ["x.y", "y.y"]}}}, "log": ["z.y"]})";
  const SweepFolder sweep(R"("x.value": {"values": [0, 1, 4]}, "y.value": {"values": [0, 1, 4]})",
                          R"(, "paired": [["x.value", "y.value"]])", R"("z": {"final": "z.y"})", gap);
  const Optimum best = optimise(sweep.plan(), {.metric = "z"});
  ASSERT_TRUE(best.found);
  EXPECT_NEAR(best.value, 1, 1e-5);
  EXPECT_NEAR(best.point[0], 3, 1e-2);
  EXPECT_NEAR(best.point[1], best.point[0], 1e-12);
}

TEST(Optimise, NamesTheMetricThatWasProbablyMeant) {
  const SweepFolder sweep(R"("mass.mass": {"values": [1, 2]})", "",
                          R"("tracking": {"rms": "mass.position"})");
  EXPECT_THROW(optimise(sweep.plan(), {.metric = "traking"}), InputError);
}

}  // namespace
}  // namespace loopwright::optimise_test
