// A fault of any method of any block ends the run and names the block.
#include <gtest/gtest.h>
#include "engine/lanes/lane_run.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::fault_test {
namespace {

constexpr const char* reason = "as the test wants";

uint64_t fault(const Call<double>& call) {
  return report_fault(call.report, call.index, {uint64_t(1) << call.first_lane, reason});
}
uint64_t fault_after_half(const Call<double>& call) { return call.now->time >= 0.5 ? fault(call) : 0; }

/// Every kind of method: a sampled sum, an integrator with reset, a delay that accepts.
std::string all_methods(std::string_view solver) {
  return diagram(
      R"("t": {"type": "Clock"}, "s": {"type": "Sine", "frequency": 1}, "late": {"type": "TransportDelay", "delay": 0.1, "in": {"u": "x.y"}},
    "x": {"type": "Integrator", "in": {"u": "s.y", "reset": "s.y"}}, "d": {"type": "UnitDelay", "sample_time": 0.05, "in": {"u": "late.y"}})",
      solver);
}

struct Case {
  const char *block, *method, *solver;
  Step<double> Kernels<double>::*slot;
};

class EveryMethod : public ::testing::TestWithParam<Case> {};

TEST_P(EveryMethod, ThatFaultsEndsTheRun) {
  const Case& wanted = GetParam();
  Plan plan = *plan_of(all_methods(wanted.solver));
  BlockType type{};
  for (Plan::Block& block : plan.blocks)
    if (block.path == wanted.block) {
      type = *block.type;
      ASSERT_NE(type.kernels.*wanted.slot, nullptr);
      type.kernels.*wanted.slot = &fault_after_half;
      if (wanted.slot == &Kernels<double>::derivatives)
        type.kernels.to_next_stage = type.kernels.to_next_step = &fault_after_half;
      block.type = &type;
    }
  const RunResult result = simulate(plan);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_TRUE(has(result.message, fmt::format("\"{}\" stopped the run at t = ", wanted.block)) &&
              has(result.message, reason))
      << result.message;
  EXPECT_NEAR(result.time, 0.5, 0.11);
  for (const double time : signal(result, "time")) EXPECT_LE(time, 0.61);
}

constexpr const char *rk4 = R"("stop": 1, "step": 0.05)",
                     *dopri5 = R"("stop": 1, "method": "dopri5", "record_step": 0.05)",
                     *bdf = R"("stop": 1, "method": "cvode-bdf", "record_step": 0.05)";
using K = Kernels<double>;
INSTANTIATE_TEST_SUITE_P(
    Of, EveryMethod,
    ::testing::Values(Case{"x", "derivatives", rk4, &K::derivatives},
                      Case{"x", "derivatives", dopri5, &K::derivatives},
                      Case{"x", "derivatives", bdf, &K::derivatives}, Case{"x", "decide", rk4, &K::decide},
                      Case{"x", "decide", dopri5, &K::decide}, Case{"x", "jump", rk4, &K::jump},
                      Case{"x", "jump", dopri5, &K::jump}, Case{"x", "jump", bdf, &K::jump},
                      Case{"x", "crossings", dopri5, &K::crossings},
                      Case{"x", "crossings", bdf, &K::crossings}, Case{"late", "accept", rk4, &K::accept},
                      Case{"late", "accept", dopri5, &K::accept}, Case{"d", "update", rk4, &K::update},
                      Case{"d", "update", dopri5, &K::update}),
    [](const auto& one) { return fmt::format("{}{}", one.param.method, one.index); });

// A block for this test only, never registered.
template <class Real> struct Refuses {
  Real at_prepare = 0.0, at_start = 0.0, at_jump = 0.0;
  struct State {
    Real x;
  };
  static constexpr auto describe() {
    return block("Refuses.", parameter(&Refuses::at_prepare, "at_prepare", "", "").optional(),
                 parameter(&Refuses::at_start, "at_start", "", "").optional(),
                 parameter(&Refuses::at_jump, "at_jump", "", "").optional());
  }
  Fault prepare(double) { return fault_if(at_prepare > 0.0, "at prepare"); }
  Fault start(State&) const { return fault_if(at_start > 0.0, "at start"); }
  Fault jump(State& state) const {
    state.x = state.x + 1.0;
    return fault_if(at_jump > 0.0, "at jump");
  }
};

TEST(Fault, OfPrepareStartAndJumpIsAnswered) {
  const Kernels<double> kernels = kernels_of<Refuses<double>, double>();
  for (int which = 0; which < 4; ++which) {
    Refuses<double> block;
    block.at_prepare = which == 1, block.at_start = which == 2, block.at_jump = which == 3;
    double state = 0;
    uint64_t jumped = 0;
    FaultReport report;
    const Instant now;
    Call<double> call;
    call.block = &block, call.state = &state, call.report = &report, call.now = &now, call.jumped = &jumped;
    call.mode = call.memory = &state;
    EXPECT_EQ(start_by(kernels, &block, call, {}), which == 1 || which == 2 ? 1u : 0u) << which;
    EXPECT_EQ(kernels.jump(call), which == 3 ? 1u : 0u) << which;
    EXPECT_EQ(jumped, 1u);
    EXPECT_STREQ(report.reason, which == 0   ? ""
                                : which == 1 ? "at prepare"
                                : which == 2 ? "at start"
                                             : "at jump");
  }
}

TEST(Fault, AtTheStartEndsTheRunBeforeItsFirstRow) {
  Plan plan = *plan_of(all_methods(rk4));
  BlockType type = *plan.blocks[0].type;
  type.kernels.prepare = [](void*, const loopwright::Setup&) { return fault_if(true, reason); };
  plan.blocks[0].type = &type;
  const RunResult result = simulate(plan);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_TRUE(has(result.message, reason)) << result.message;
  EXPECT_EQ(result.recording.rows(), 0u);
}

TEST(Fault, OfATrialThatTheSolverTookBackIsForgotten) {
  // The first trial step reaches a point at which the square root is undefined. Shorter steps do not, except
  // for another block.
  const RunResult result = run_of(diagram(
      R"json("x": {"type": "Integrator", "initial": 1, "in": {"u": "g.y"}}, "g": {"type": "Gain", "gain": -40, "in": {"u": "x.y"}},
    "root": {"type": "Expression", "formula": "sqrt(x)", "names": ["x"], "in": {"arguments": ["x.y"]}},
    "y": {"type": "Integrator", "in": {"u": "root.y"}}, "t": {"type": "Clock"},
    "end": {"type": "Constant", "value": {"value": 0.5, "unit": "s"}},
    "late": {"type": "Expression", "formula": "sqrt(end-t)", "names": ["end", "t"], "in": {"arguments": ["end.y", "t.time"]}},
    "z": {"type": "Integrator", "in": {"u": "late.y"}})json",
      R"("stop": 1, "method": "dopri5", "record_step": 0.1, "relative_tolerance": 1e-3, "absolute_tolerance": 1e-3)"));
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_TRUE(has(result.message, "\"late\"") || result.time < 0.45) << result.message;
}

/// Two integrators that reset each other endlessly, as soon as x differs from y by a half.
std::string restless(std::string_view solver) {
  return diagram(
      R"("one": {"type": "Constant", "value": {"value": 1, "unit": "1/s"}}, "half": {"type": "Constant", "value": {"value": 0.5, "unit": "1"}},
    "more": {"type": "Constant", "value": {"value": 1.01, "unit": "1"}}, "unit": {"type": "Constant", "value": {"value": 1, "unit": "1"}}, "none": {"type": "Constant", "value": {"value": 0, "unit": "1/s"}},
    "x_next": {"type": "Sum", "in": {"terms": ["x.y", "more.y"]}}, "y_next": {"type": "Sum", "in": {"terms": ["y.y", "unit.y"]}},
    "y_leads": {"type": "Sum", "signs": "+-+", "in": {"terms": ["half.y", "x.y", "y.y"]}},
    "x_leads": {"type": "Sum", "signs": "+--", "in": {"terms": ["x.y", "y.y", "half.y"]}},
    "x": {"type": "Integrator", "in": {"u": "one.y", "reset": "y_leads.sum", "reset_value": "x_next.sum"}},
    "y": {"type": "Integrator", "in": {"u": "none.y", "reset": "x_leads.sum", "reset_value": "y_next.sum"}})",
      solver);
}

TEST(Jumps, ThatDoNotSettleEndTheRunWithTheirBlock) {
  for (const char* solver :
       {R"("stop": 1, "step": 0.01)", R"("stop": 1, "method": "dopri5", "record_step": 0.01)",
        R"("stop": 1, "method": "cvode-bdf", "record_step": 0.01)"}) {
    const RunResult result = run_of(restless(solver));
    EXPECT_EQ(result.status, RunStatus::failed) << solver;
    EXPECT_NEAR(result.time, 0.5, 0.021) << solver;
    EXPECT_TRUE((has(result.message, "\"x\" stopped") || has(result.message, "\"y\" stopped")) &&
                has(result.message, "jump again and again"))
        << result.message;
  }
}

TEST(Jumps, ThatDoNotSettleEndTheirLaneAlone) {
  const auto plan = plan_of(restless(R"("stop": 1, "step": 0.01)"));
  for (const InstructionSet set : all_instruction_sets) {
    if (!lanes_unavailable(set).empty()) continue;
    const auto run = make_lane_run(*plan, set, 1);
    const int kept = run->lanes() - 1;
    if (kept > 0)
      for (int lane = 0; lane < run->lanes(); lane += 2) *run->parameter("one.value", lane) = 0.3;
    run->reset({});
    run->run();
    for (int lane = 0; lane < run->lanes(); ++lane) {
      const bool fails = kept == 0 || lane % 2 == 1;
      EXPECT_EQ(run->failed() >> lane & 1, fails) << lane;
      if (fails) {
        EXPECT_TRUE(has(to_text(run->failure(lane), *plan), "jump again and again"));
      }
    }
  }
}

TEST(AlgebraicLoop, ThatIsSingularIsAnErrorWithItsBlocks) {
  for (
      const char* blocks :
      {R"("g": {"type": "Gain", "gain": 1, "in": {"u": "g.y"}})",
       R"("a": {"type": "Gain", "gain": 2, "in": {"u": "b.y"}}, "b": {"type": "Gain", "gain": 0.5, "in": {"u": "a.y"}})",
       R"("a": {"type": "Gain", "gain": 10, "in": {"u": "b.y"}}, "b": {"type": "Gain", "gain": 0.1, "in": {"u": "a.y"}})",
       R"("a": {"type": "Sum", "in": {"terms": ["a.sum", "b.sum"]}}, "b": {"type": "Sum", "signs": "-+", "in": {"terms": ["a.sum", "a.sum"]}})"})
    for (const char* method : {R"("step": 0.1)", R"("method": "dopri5")"}) {
      const RunResult result =
          run_of(diagram(blocks, fmt::format(R"("stop": 1, {}, "algebraic_loops": "solve")", method)));
      EXPECT_EQ(result.status, RunStatus::failed) << blocks;
      EXPECT_TRUE(has(result.message, "is singular") && has(result.message, " -> ")) << result.message;
    }
  const RunResult good = run_of(diagram(
      R"("c": {"type": "Constant", "value": 3}, "s": {"type": "Sum", "signs": "+-", "in": {"terms": ["c.y", "g.y"]}},
    "g": {"type": "Gain", "gain": 1e9, "in": {"u": "s.sum"}})",
      R"("stop": 1, "step": 0.1, "algebraic_loops": "solve")"));
  ASSERT_EQ(good.status, RunStatus::finished) << good.message;
  EXPECT_NEAR(signal(good, "g.y").back(), 3 * 1e9 / (1 + 1e9), 1e-6);
}

}  // namespace
}  // namespace loopwright::fault_test
