// Algebraic loops: listed port by port, or solved.
#include <gtest/gtest.h>
#include <cmath>
#include "tests/engine/written_diagram.h"

namespace loopwright::algebraic_loop_test {
namespace {

constexpr std::string_view negative_feedback = R"("source": {"type": "Constant", "value": 3},
"error": {"type": "Sum", "signs": "+-", "in": {"terms": ["source.y", "gain.y"]}},
"gain": {"type": "Gain", "gain": 0.5, "in": {"u": "error.sum"}})";

TEST(AlgebraicLoop, IsPrintedPortByPortWithWhatBreaksIt) {
  EXPECT_EQ(problems_of(diagram(negative_feedback)),
            R"(top.json:3:1: error: algebraic loop: each of these needs the next in the same instant
    error.sum -> gain.u
    gain.y -> error.terms
  block: error
  expected: a state or a delay somewhere in the loop
  hint: a UnitDelay (sampled) or a LowPass (continuous) at one of these wires breaks it; "algebraic_loops": "solve" in "solver" solves it by Newton's method.
1 error)");
}

TEST(AlgebraicLoop, OfOneBlockIsARing) {
  const std::string text = problems_of(diagram(R"("g": {"type": "Gain", "gain": 0.5, "in": {"u": "g.y"}})"));
  EXPECT_TRUE(has(text, "\n    g.y -> g.u\n")) << text;
}

TEST(AlgebraicLoop, ThroughSubdiagramsNamesTheBlocksInside) {
  DiagramFolder folder;
  folder.with(
      "inner.json",
      R"({"loopwright": 1, "inputs": {"u": {}}, "outputs": {"y": "g.y"}, "blocks": {"g": {"type": "Gain", "gain": 1, "in": {"u": "u"}}}})");
  folder.with(
      "top.json",
      diagram(
          R"("a": {"diagram": "inner.json", "in": {"u": "b.y"}}, "b": {"diagram": "inner.json", "in": {"u": "a.y"}})"));
  const std::string text = problems_in(folder);
  EXPECT_TRUE(has(text, "a.g.y -> b.g.u")) << text;
  EXPECT_TRUE(has(text, "b.g.y -> a.g.u")) << text;
}

TEST(AlgebraicLoop, EveryRingIsToldNotOnlyTheFirst) {
  const std::string text = problems_of(diagram(
      R"("a": {"type": "Gain", "gain": 1, "in": {"u": "a.y"}}, "b": {"type": "Gain", "gain": 1, "in": {"u": "b.y"}})"));
  EXPECT_TRUE(has(text, "2 errors")) << text;
}

TEST(AlgebraicLoop, AnyStateOrDelayBreaksIt) {
  for (const char* breaker :
       {R"("type": "UnitDelay", "sample_time": 0.1)", R"("type": "LowPass", "cutoff": 10)",
        R"("type": "Integrator")", R"("type": "TransportDelay", "delay": 0.1)",
        R"("type": "Delay", "samples": 2, "sample_time": 0.1)"})
    EXPECT_EQ(problems_of(diagram(fmt::format(
                  R"("sum": {{"type": "Sum", "signs": "+-", "in": {{"terms": ["one.y", "breaker.y"]}}}},
      "one": {{"type": "Constant", "value": 1}}, "breaker": {{{}, "in": {{"u": "sum.sum"}}}})",
                  breaker))),
              "")
        << breaker;
}

TEST(AlgebraicLoop, ALinearRingIsSolvedToItsAnalyticSolution) {
  const RunResult result =
      run_of(diagram(negative_feedback, R"("stop": 1, "step": 0.1, "algebraic_loops": "solve")"));
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  for (double e : signal(result, "error.sum")) EXPECT_NEAR(e, 2, 1e-12);  // e = 3 - e/2
}

TEST(AlgebraicLoop, ANonlinearRingFollowsItsSourceAtEveryStep) {
  // y = cos(y) + t: y - cos(y) - t = 0 has one solution, because its slope 1 + sin(y) is nowhere negative.
  const RunResult result = run_of(diagram(
      R"("t": {"type": "Clock"}, "f": {"type": "Expression", "formula": "cos(y)+t", "names": ["y", "t"], "in": {"arguments": ["f.y", "t.time"]}})",
      R"("stop": 1, "step": 0.01, "algebraic_loops": "solve")"));
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  for (size_t i = 0; i < result.recording.rows(); ++i) {
    const double y = signal(result, "f.y")[i];
    EXPECT_NEAR(y - std::cos(y), signal(result, "t.time")[i], 1e-9) << i;
  }
  EXPECT_NEAR(signal(result, "f.y")[0], 0.7390851332151607, 1e-10);
}

TEST(AlgebraicLoop, ACoupledPairIsSolvedTogether) {
  // a = 1 + b/2 - c/4, b = a/3, c = b + a/5: a = 60/55
  const RunResult result = run_of(diagram(R"("one": {"type": "Constant", "value": 1},
    "a": {"type": "Expression", "formula": "one+b/2-c/4", "names": ["one", "b", "c"], "in": {"arguments": ["one.y", "b.y", "c.y"]}},
    "b": {"type": "Expression", "formula": "a/3", "names": ["a"], "in": {"arguments": ["a.y"]}},
    "c": {"type": "Expression", "formula": "b+a/5", "names": ["b", "a"], "in": {"arguments": ["b.y", "a.y"]}})",
                                          R"("stop": 1, "step": 0.5, "algebraic_loops": "solve")"));
  const double a = 1 / (1 - 1.0 / 6 + (1.0 / 3 + 0.2) / 4);
  EXPECT_NEAR(signal(result, "a.y").back(), a, 1e-12);
  EXPECT_NEAR(signal(result, "c.y").back(), a / 3 + a / 5, 1e-12);
}

TEST(AlgebraicLoop, InsideAStageIsSolvedAtEveryStage) {
  // dx/dt = v, v = -x - v/2, so x decays as exp(-2/3 t). Fourth order is reached only if every stage is
  // solved.
  const RunResult result = run_of(diagram(R"("x": {"type": "Integrator", "initial": 1, "in": {"u": "v.y"}},
    "v": {"type": "Expression", "formula": "-x-v/2", "names": ["x", "v"], "in": {"arguments": ["x.y", "v.y"]}})",
                                          R"("stop": 1, "step": 0.01, "algebraic_loops": "solve")"));
  EXPECT_NEAR(signal(result, "x.y").back(), std::exp(-2.0 / 3), 1e-10);
}

TEST(AlgebraicLoop, InsideASampledRateIsSolvedAtItsSamplesAndHeldBetween) {
  // e = t - e/2 at the samples.
  const RunResult result =
      run_of(diagram(R"("t": {"type": "Clock", "sample_time": 0.2},
    "e": {"type": "Sum", "signs": "+-", "in": {"terms": ["t.time", "g.y"]}}, "g": {"type": "Gain", "gain": {"value": 0.5, "unit": "1"}, "in": {"u": "e.sum"}})",
                     R"("stop": 1, "step": 0.05, "record_step": 0.05, "algebraic_loops": "solve")"));
  ASSERT_EQ(result.recording.rows(), 21u);
  for (size_t i = 0; i < 21; ++i)
    EXPECT_NEAR(signal(result, "e.sum")[i], double(i / 4) * 0.2 / 1.5, 1e-12) << i;
}

TEST(AlgebraicLoop, WithoutASolutionFailsTheRunAndNamesABlock) {
  const RunResult result = run_of(diagram(
      R"("f": {"type": "Expression", "formula": "y*y+1", "names": ["y"], "in": {"arguments": ["f.y"]}})",
      R"("stop": 1, "step": 0.1, "algebraic_loops": "solve")"));
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_TRUE(has(result.message, "\"f\"")) << result.message;
  EXPECT_TRUE(has(result.message, "did not converge")) << result.message;
}

TEST(AlgebraicLoop, OfASwitchingBlockIsRefusedWithTheReason) {
  const std::string text = problems_of(
      diagram(R"("s": {"type": "Sign", "in": {"u": "s.y"}})", R"("stop": 1, "algebraic_loops": "solve")"));
  EXPECT_TRUE(has(text, "block that switches")) << text;
}

}  // namespace
}  // namespace loopwright::algebraic_loop_test
