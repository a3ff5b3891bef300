// Runs that fail end with a reason, the block, and the rows computed so far. Runs that might fail give a
// warning.
#include <gtest/gtest.h>
#include <atomic>
#include <cmath>
#include "tests/engine/written_diagram.h"

namespace loopwright::failure_test {
namespace {

TEST(Failure, ADivergingRunNamesTheBlockAndKeepsItsRows) {
  for (const char* solver :
       {R"("stop": 100, "step": 0.01)", R"("stop": 100, "method": "dopri5", "record_step": 0.01)",
        R"("stop": 100, "method": "cvode-bdf", "record_step": 0.01)"}) {
    // dx/dt = x²: infinite at t = 1.
    const RunResult result = run_of(diagram(
        R"("x": {"type": "Integrator", "initial": 1, "in": {"u": "square.product"}}, "square": {"type": "Product", "in": {"factors": ["x.y", "x.y"]}})",
        solver));
    EXPECT_EQ(result.status, RunStatus::failed) << solver;
    EXPECT_TRUE(has(result.message, "\"x\"") || has(result.message, "\"x.y\"") ||
                has(result.message, "\"square.product\""))
        << result.message;
    EXPECT_NEAR(result.time, 1, 0.15) << solver;
    EXPECT_GE(result.recording.rows(), 99u) << solver;
    for (size_t i = 0; i < 90; ++i)
      EXPECT_NEAR(signal(result, "x.y")[i], 1 / (1 - 0.01 * double(i)), 1e-2) << solver << i;
    bool noted = false;
    for (const auto& [name, value] : result.recording.facts)
      noted |= name == "incomplete" && value == result.message;
    EXPECT_TRUE(noted) << "the file must say that it is not whole";
  }
}

TEST(Failure, ANumberThatIsNoneIsFoundAtItsSource) {
  // An overflow two blocks before the logged signal.
  const RunResult result = run_of(diagram(
      R"("big": {"type": "Ramp", "slope": 1e200}, "q": {"type": "Product", "in": {"factors": ["big.y", "big.y"]}}, "g": {"type": "Gain", "gain": 2, "in": {"u": "q.product"}})",
      R"("stop": 1, "step": 0.1)", R"(, "log": ["g.y"])"));
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_TRUE(has(result.message, "\"q.product\"")) << result.message;
}

TEST(Failure, OfABlockGivesItsReasonAndTheTime) {
  for (const char* solver :
       {R"("stop": 1, "step": 0.1)", R"("stop": 1, "method": "dopri5", "record_step": 0.1)"}) {
    const RunResult result = run_of(diagram(
        R"json("t": {"type": "Clock"}, "end": {"type": "Constant", "value": {"value": 0.55, "unit": "s"}},
      "e": {"type": "Expression", "formula": "sqrt(end-t)", "names": ["end", "t"], "in": {"arguments": ["end.y", "t.time"]}},
      "x": {"type": "Integrator", "in": {"u": "e.y"}})json",
        solver));
    EXPECT_EQ(result.status, RunStatus::failed) << solver;
    EXPECT_TRUE(has(result.message, "\"e\" stopped the run") && has(result.message, "non-finite number"))
        << result.message;
    EXPECT_GE(result.recording.rows(), 6u) << solver;
    EXPECT_LE(result.time, 0.7) << solver;
  }
}

TEST(Failure, AtTheVeryLastTickIsAFailureToo) {
  for (const char* solver :
       {R"("stop": 1, "step": 0.1)", R"("stop": 1, "method": "dopri5", "record_step": 0.1)"}) {
    const RunResult result = run_of(diagram(
        R"("t": {"type": "Clock", "sample_time": 0.1}, "e": {"type": "Expression", "formula": "t > 0.95 ? ln(-1) + 0 : 0", "names": ["t"], "in": {"arguments": ["t.time"]}},
      "x": {"type": "Integrator", "in": {"u": "t.time"}})",
        solver));
    EXPECT_EQ(result.status, RunStatus::failed) << solver;
  }
}

TEST(Failure, AtTheStartIsTold) {
  const RunResult result = run_of(diagram(
      R"("e": {"type": "Expression", "formula": "ln(-1) + c", "names": ["c"], "in": {"arguments": ["c.y"]}}, "c": {"type": "Constant", "value": 1})"));
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_TRUE(has(result.message, "\"e\"")) << result.message;
}

TEST(Warning, AStepTooLongForTheFastestPoleNamesItsBlock) {
  const auto warnings = [](std::string_view method, double step) {
    const RunResult result = run_of(diagram(
        R"("slow": {"type": "Integrator", "in": {"u": "back.sum"}}, "fast": {"type": "ActuatorLag", "time_constant": 0.001, "in": {"command": "slow.y"}},
      "one": {"type": "Constant", "value": 1}, "back": {"type": "Sum", "signs": "+-", "in": {"terms": ["one.y", "fast.force"]}})",
        fmt::format(R"("stop": 0.01, "method": "{}", "step": {})", method, step)));
    std::string all;
    for (const std::string& w : result.warnings) all += w + "\n";
    return all;
  };
  const std::string too_long = warnings("rk4", 0.005);
  EXPECT_TRUE(has(too_long, "too long for the fastest pole") && has(too_long, "\"fast\"") &&
              has(too_long, "rk4 is stable up to 0.0027"))
      << too_long;
  EXPECT_TRUE(has(warnings("rk4", 0.0026), "near the limit"));
  EXPECT_EQ(warnings("rk4", 0.001), "");
  EXPECT_TRUE(has(warnings("euler", 0.0025), "too long"));
  EXPECT_EQ(warnings("euler", 0.001), "");
}

TEST(Warning, OfStiffnessNamesTheBlock) {
  const RunResult result = run_of(diagram(
      R"("s": {"type": "Sine", "frequency": 0.1}, "stiff": {"type": "ActuatorLag", "time_constant": 1e-5, "in": {"command": "s.y"}},
    "x": {"type": "Integrator", "in": {"u": "stiff.force"}})",
      R"("stop": 0.2, "method": "dopri5", "record_step": 0.01)"));
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_TRUE(has(result.warnings[0], "\"stiff\" makes the diagram stiff") &&
              has(result.warnings[0], "cvode-bdf"))
      << result.warnings[0];
}

TEST(Interruption, KeepsTheRowsSoFar) {
  for (const char* solver :
       {R"("stop": 1000, "step": 0.001)",
        R"("stop": 1000, "method": "dopri5", "record_step": 0.001, "maximum_step": 0.001)"}) {
    const auto plan = plan_of(
        diagram(R"("t": {"type": "Clock"}, "x": {"type": "Integrator", "in": {"u": "t.time"}})", solver));
    std::atomic<bool> stop = false;
    RunOptions options;
    options.interrupt = &stop;
    options.progress = [&](double time, double end) {
      EXPECT_EQ(end, 1000);
      if (time > 5) stop = true;
    };
    const RunResult result = simulate(*plan, options);
    EXPECT_EQ(result.status, RunStatus::interrupted) << solver;
    EXPECT_TRUE(has(result.message, "interrupted at t = ")) << result.message;
    EXPECT_GT(result.time, 5);
    EXPECT_LT(result.time, 10);
    EXPECT_GT(result.recording.rows(), 5000u);
    EXPECT_NEAR(signal(result, "time").back(), result.time, 0.0021);
  }
}

}  // namespace
}  // namespace loopwright::failure_test
