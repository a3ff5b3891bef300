// The step as documented in engine/run/run.h, observed through blocks that record when they were called.
#include <gtest/gtest.h>
#include "tests/engine/written_diagram.h"

namespace loopwright::order_test {
namespace {

TEST(StepOrder, ASampledChainIsReadInTheTickInWhichItIsComputed) {
  // Sampled read of a continuous state, an algebraic block, and the state that it drives: no tick of delay in
  // between.
  const RunResult result = run_of(diagram(R"("x": {"type": "Integrator", "initial": 1, "in": {"u": "g.y"}},
    "hold": {"type": "ZeroOrderHold", "sample_time": 0.1, "in": {"u": "x.y"}}, "g": {"type": "Gain", "gain": -1, "in": {"u": "hold.y"}})",
                                          R"("stop": 1, "step": 0.01, "record_step": 0.1)"));
  double x = 1;
  for (size_t k = 0; k < 11; ++k) {
    EXPECT_NEAR(signal(result, "x.y")[k], x, 1e-14) << k;
    EXPECT_EQ(signal(result, "hold.y")[k], signal(result, "x.y")[k]) << "the sample of this very tick";
    x -= 0.1 * x;  // held over the tick: an exact Euler step
  }
}

TEST(StepOrder, UpdatesTakeFrozenInputs) {
  // Two delays that exchange their values: updating one before the other must have no effect.
  const RunResult result =
      run_of(diagram(R"("a": {"type": "UnitDelay", "sample_time": 0.1, "initial": 1, "in": {"u": "b.y"}},
    "b": {"type": "UnitDelay", "sample_time": 0.1, "initial": 2, "in": {"u": "a.y"}})"));
  for (size_t k = 0; k < 11; ++k) {
    EXPECT_EQ(signal(result, "a.y")[k], k % 2 ? 2 : 1) << k;
    EXPECT_EQ(signal(result, "b.y")[k], k % 2 ? 1 : 2) << k;
  }
}

TEST(StepOrder, ARowShowsOutputsBeforeTheUpdateOfItsTick) {
  const RunResult result = run_of(diagram(
      R"("one": {"type": "Constant", "value": 1}, "d": {"type": "UnitDelay", "sample_time": 0.1, "initial": 0, "in": {"u": "s.sum"}},
    "s": {"type": "Sum", "in": {"terms": ["one.y", "d.y"]}})"));
  for (size_t k = 0; k < 11; ++k) {
    EXPECT_EQ(signal(result, "d.y")[k], double(k));
    EXPECT_EQ(signal(result, "s.sum")[k], double(k + 1));
  }
}

TEST(StepOrder, SampledSignalsAreHeldBetweenTheirTicks) {
  for (const char* solver : {R"("stop": 1, "step": 0.01, "record_step": 0.01)",
                             R"("stop": 1, "method": "dopri5", "record_step": 0.01)"}) {
    const RunResult result = run_of(diagram(
        R"("t": {"type": "Clock"}, "h": {"type": "ZeroOrderHold", "sample_time": 0.1, "in": {"u": "t.time"}},
      "x": {"type": "Integrator", "in": {"u": "h.y"}})",
        solver));
    ASSERT_EQ(result.recording.rows(), 101u) << solver;
    double area = 0;
    for (size_t i = 0; i < 101; ++i) {
      EXPECT_EQ(signal(result, "h.y")[i], double(i / 10) / 10) << solver << " row " << i;
      EXPECT_NEAR(signal(result, "x.y")[i], area, 1e-12) << solver << " row " << i;
      area += 0.01 * double(i / 10) / 10;
    }
  }
}

TEST(StepOrder, AContinuousReaderSeesTheSampleOfTheSameTick) {
  const RunResult result = run_of(
      diagram(R"("n": {"type": "Noise", "sample_time": 0.1, "standard_deviation": 1}, "t": {"type": "Clock"},
    "e": {"type": "Expression", "formula": "n+0*t", "names": ["n", "t"], "in": {"arguments": ["n.y", "t.time"]}})"));
  EXPECT_EQ(signal(result, "n.y"), signal(result, "e.y"));
}

TEST(StepOrder, AResetIsSeenByEverybodyInTheTickInWhichItHappens) {
  // The integrator is reset to 0 when the clock passes 0.5. The sampled reader of that tick sees the new
  // value.
  for (const char* solver :
       {R"("stop": 1, "step": 0.1)", R"("stop": 1, "method": "dopri5", "record_step": 0.1)"}) {
    const RunResult result = run_of(diagram(
        R"("t": {"type": "Clock"}, "s": {"type": "Step", "time": 0.5}, "one": {"type": "Constant", "value": 1},
      "x": {"type": "Integrator", "in": {"u": "one.y", "reset": "s.y"}}, "h": {"type": "ZeroOrderHold", "sample_time": 0.1, "in": {"u": "x.y"}})",
        solver));
    for (size_t k = 0; k < 11; ++k) {
      EXPECT_NEAR(signal(result, "x.y")[k], k < 5 ? 0.1 * double(k) : 0.1 * double(k) - 0.5, 1e-12)
          << solver << k;
      EXPECT_EQ(signal(result, "h.y")[k], signal(result, "x.y")[k]) << solver << k;
    }
  }
}

TEST(StepOrder, ARowAtADiscontinuityShowsTheValueAfterItWithEveryMethod) {
  // A known discontinuity at 0.5, pulses from 0.3 on, and an event of the relay at 0.7; with and without
  // samples at these instants.
  for (const char* solver :
       {R"("method": "rk4", "step": 0.1)", R"("method": "dopri5")", R"("method": "cvode-bdf")"})
    for (const char* sampler :
         {"", R"(, "h": {"type": "ZeroOrderHold", "sample_time": 0.1, "in": {"u": "t.time"}})"}) {
      const RunResult result = run_of(diagram(
          fmt::format(
              R"("s": {{"type": "Step", "time": 0.5}}, "x": {{"type": "Integrator", "in": {{"u": "s.y"}}}},
      "p": {{"type": "PulseTrain", "start": 0.3, "period": 0.4, "width": 0.2}},
      "reset": {{"type": "Integrator", "initial": 1, "in": {{"u": "s.y", "reset": "late.y"}}}}, "late": {{"type": "Step", "time": 0.8}},
      "t": {{"type": "Clock"}}{})",
              sampler),
          fmt::format(R"("stop": 1, {}, "record_step": 0.1)", solver)));
      ASSERT_EQ(result.recording.rows(), 11u) << solver;
      for (size_t k = 0; k < 11; ++k) {
        EXPECT_EQ(signal(result, "time")[k], double(k) / 10) << solver << sampler;
        EXPECT_EQ(signal(result, "s.y")[k], k < 5 ? 0 : 1) << solver << sampler << " row " << k;
        EXPECT_EQ(signal(result, "p.y")[k], k == 3 || k == 4 || k == 7 || k == 8 ? 1 : 0)
            << solver << sampler << " row " << k;
        EXPECT_NEAR(signal(result, "reset.y")[k],
                    k < 5   ? 1
                    : k < 8 ? 0.5 + 0.1 * double(k)
                            : 0.1 * double(k) - 0.8,
                    1e-6)
            << solver << sampler << " row " << k;
      }
    }
}

TEST(StepOrder, TheOrderInTheFileDoesNotMatter) {
  const std::string x = R"("x": {"type": "Integrator", "initial": 1, "in": {"u": "g.y"}})",
                    g = R"("g": {"type": "Gain", "gain": -2, "in": {"u": "h.y"}})",
                    h = R"("h": {"type": "ZeroOrderHold", "sample_time": 0.1, "in": {"u": "x.y"}})";
  const std::string log = R"(, "log": ["x.y", "g.y", "h.y"])", solver = R"("stop": 1, "step": 0.01)";
  const RunResult one = run_of(diagram(x + "," + g + "," + h, solver, log)),
                  other = run_of(diagram(h + "," + g + "," + x, solver, log));
  for (size_t c = 0; c < one.recording.columns.size(); ++c)
    EXPECT_EQ(one.recording.columns[c].values, other.recording.columns[c].values);
}

}  // namespace
}  // namespace loopwright::order_test
