// The smallest and the largest diagrams.
#include <gtest/gtest.h>
#include <cmath>
#include <ctime>
#include "tests/engine/written_diagram.h"

namespace loopwright::size_test {
namespace {

TEST(Size, NoBlocksAtAllRunToTheEnd) {
  const RunResult result = run_of(diagram("", R"("stop": 1, "step": 0.1)"));
  EXPECT_EQ(result.status, RunStatus::finished);
  EXPECT_EQ(result.recording.rows(), 11u);
  for (const char* method : {"dopri5", "cvode-bdf", "euler"})
    EXPECT_EQ(run_of(diagram("", fmt::format(R"("stop": 1, "method": "{}")", method))).status,
              RunStatus::finished)
        << method;
}

TEST(Size, NoStatesRunWithEveryMethod) {
  for (const char* method : {"euler", "heun", "rk4", "dopri5", "cvode-bdf", "cvode-adams"}) {
    const RunResult result = run_of(diagram(
        R"("s": {"type": "Sine", "frequency": 1}, "g": {"type": "Gain", "gain": 2, "in": {"u": "s.y"}})",
        fmt::format(R"("stop": 1, "record_step": 0.1, "method": "{}")", method)));
    EXPECT_EQ(result.status, RunStatus::finished) << method;
    EXPECT_EQ(result.recording.rows(), 11u) << method;
  }
}

TEST(Size, APurelySampledDiagramRunsWithEveryMethod) {
  for (const char* method : {"rk4", "dopri5", "cvode-bdf"}) {
    // A counter: y[k+1] = y[k] + 1.
    const RunResult result = run_of(diagram(
        R"("one": {"type": "Constant", "value": 1}, "d": {"type": "UnitDelay", "sample_time": 0.1, "in": {"u": "s.sum"}},
      "s": {"type": "Sum", "in": {"terms": ["d.y", "one.y"]}})",
        fmt::format(R"("stop": 1, "method": "{}")", method)));
    ASSERT_EQ(result.recording.rows(), 11u) << method;
    for (size_t i = 0; i < 11; ++i) EXPECT_EQ(signal(result, "d.y")[i], double(i)) << method;
  }
}

TEST(Size, OnlyConstantsRun) {
  EXPECT_EQ(signal(run_of(diagram(R"("c": {"type": "Constant", "value": 4})")), "c.y").back(), 4);
}

TEST(Size, ARunOfNoDurationHasOneRow) {
  for (const char* solver :
       {R"("stop": 0)", R"("start": 2, "stop": 2)", R"("stop": 0, "method": "dopri5")"}) {
    const RunResult result = run_of(
        diagram(R"("x": {"type": "Integrator", "initial": 5, "in": {"u": "c.time"}}, "c": {"type": "Clock"})",
                solver));
    EXPECT_EQ(result.status, RunStatus::finished) << solver;
    ASSERT_EQ(result.recording.rows(), 1u) << solver;
    EXPECT_EQ(signal(result, "x.y")[0], 5);
  }
}

/// A chain of `blocks` lags, closed to a loop through its states, written in an unfavorable order.
std::string chain(int blocks) {
  std::string text;
  for (int i = 0; i < blocks; ++i) {
    const int k = int((int64_t(i) * 7919) % blocks);  // 7919 is prime: every number once
    text += i ? ",\n" : "";
    text += k % 2 ? fmt::format(R"("b{}": {{"type": "Gain", "gain": 0.5, "in": {{"u": "b{}.y"}}}})", k, k - 1)
                  : fmt::format(R"("b{}": {{"type": "Integrator", "initial": 1, "in": {{"u": "b{}.y"}}}})", k,
                                (k + blocks - 1) % blocks);
  }
  return diagram(text, R"("stop": 0.01, "step": 0.01)", R"(, "log": ["b0.y"])");
}

double processor_seconds_to_compile(int blocks) {
  const std::string text = chain(blocks);
  const std::clock_t started = std::clock();
  const auto plan = plan_of(text);
  EXPECT_EQ(plan->blocks.size(), size_t(blocks));
  EXPECT_EQ(plan->states, blocks / 2);
  return double(std::clock() - started) / CLOCKS_PER_SEC;
}

TEST(Size, AThousandBlocksCompileAndRun) {
  const RunResult result = run_of(chain(1000));
  EXPECT_EQ(result.status, RunStatus::finished);
  EXPECT_NEAR(signal(result, "b0.y").back(), std::exp(0.5 * 0.01), 1e-12)
      << "every state grows as the one before it";
}

TEST(Size, TheCostOfABlockDoesNotGrowWithTheirNumber) {
  // Generous, for a loaded machine. Any quadratic step would increase it to ten.
  const double few = processor_seconds_to_compile(2000) / 2000,
               many = processor_seconds_to_compile(20000) / 20000;
  EXPECT_LT(many, 4 * few) << "seconds a block: " << few << " of 2,000, " << many << " of 20,000";
}

TEST(Size, AHundredThousandBlocksCompile) { EXPECT_EQ(plan_of(chain(100'000))->blocks.size(), 100'000u); }

TEST(Size, AHundredThousandBlocksInALineOfFeedthroughDoNotExhaustTheStack) {
  std::string text = R"("b0": {"type": "Clock"})";
  text += R"(, "b1": {"type": "Gain", "gain": 1, "in": {"u": "b0.time"}})";
  for (int i = 2; i < 100'000; ++i)
    text += fmt::format(",\n\"b{}\": {{\"type\": \"Gain\", \"gain\": 1, \"in\": {{\"u\": \"b{}.y\"}}}}", i,
                        i - 1);
  const RunResult result = run_of(diagram(text, R"("stop": 1, "step": 1)", R"(, "log": ["b99999.y"])"));
  EXPECT_EQ(signal(result, "b99999.y").back(), 1);
}

}  // namespace
}  // namespace loopwright::size_test
