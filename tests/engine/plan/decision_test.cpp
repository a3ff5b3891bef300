// Outputs that read the mode only are ordered after the decision.
#include <gtest/gtest.h>
#include "engine/block.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::decision_test {

/// The ports of the following blocks, whose output is the sign that they decided.
struct SignBlock {
  struct In {
    double u;
  };
  struct Out {
    double y;
  };
  struct Mode {
    double sign;
  };
  static constexpr auto describe() {
    return block("Sign of a signal.", input(&In::u, "u", "", "Signal"),
                 output(&Out::y, "y", "", "Sign").from_memory());
  }
};

struct DecidedSign : SignBlock {
  void decide(const In& in, Mode& mode) const { mode.sign = in.u > 0 ? 1.0 : -1.0; }
  void outputs(const Mode& mode, Out& out) const { out.y = mode.sign; }
};
LOOPWRIGHT_BLOCK(DecidedSign)

/// The same, and it accepts the input of each instant: its output is the decided sign of the present input.
struct RememberedSign : SignBlock {
  struct Memory {
    double last;
  };
  void decide(const In& in, Mode& mode) const { mode.sign = in.u > 0 ? 1.0 : -1.0; }
  void outputs(const Mode& mode, Out& out) const { out.y = mode.sign; }
  void accept(const In& in, Memory& memory) const { memory.last = in.u; }
};
LOOPWRIGHT_BLOCK(RememberedSign)

/// The opposite of the sign that it accepted at the instant before: its decision reads memory only.
struct DelayedSign : SignBlock {
  struct Memory {
    double last;
  };
  void decide(const Memory& memory, Mode& mode) const { mode.sign = memory.last > 0 ? -1.0 : 1.0; }
  void outputs(const Mode& mode, Out& out) const { out.y = mode.sign; }
  void accept(const In& in, Memory& memory) const { memory.last = in.u; }
};
LOOPWRIGHT_BLOCK(DelayedSign)

namespace {

TEST(Decision, AnOutputOfTheModeFollowsItsDecisionDespiteAcceptedMemory) {
  const RunResult result = run_of(diagram(
      R"("r": {"type": "Ramp", "initial": -0.35, "slope": 1}, "e": {"type": "RememberedSign", "in": {"u": "r.y"}})",
      R"("stop": 1, "step": 0.1, "record_step": 0.1)"));
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  for (size_t k = 0; k < 11; ++k) EXPECT_EQ(signal(result, "e.y")[k], k < 4 ? -1 : 1) << "row " << k;
  EXPECT_PRED2(has, problems_of(diagram(R"("e": {"type": "RememberedSign", "in": {"u": "e.y"}})")),
               "algebraic loop");
}

TEST(Decision, OfMemoryAloneMayCloseALoop) {
  const RunResult result = run_of(diagram(R"("e": {"type": "DelayedSign", "in": {"u": "e.y"}})",
                                          R"("stop": 0.5, "step": 0.1, "record_step": 0.1)"));
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  for (size_t k = 0; k < 6; ++k) EXPECT_EQ(signal(result, "e.y")[k], k % 2 ? -1 : 1) << "row " << k;
}

TEST(Decision, AnOutputOfTheModeAloneFollowsItsDecision) {
  // The input is sampled and has the signs - - - - + + + + + + (-): each sign holds from its own sample on.
  for (const char* method : {R"("rk4", "step": 0.1)", R"("dopri5")", R"("cvode-bdf")"}) {
    const RunResult result = run_of(diagram(
        R"("r": {"type": "Ramp", "initial": -0.35, "slope": 1, "sample_time": 0.1}, "e": {"type": "DecidedSign", "in": {"u": "r.y"}},
      "x": {"type": "Integrator", "in": {"u": "e.y"}})",
        fmt::format(R"("stop": 1, "record_step": 0.1, "method": {})", method)));
    ASSERT_EQ(result.status, RunStatus::finished) << method << result.message;
    for (size_t k = 0; k < 11; ++k) {
      EXPECT_EQ(signal(result, "e.y")[k], k < 4 ? -1 : 1) << method << " row " << k;
      EXPECT_NEAR(signal(result, "x.y")[k], k < 4 ? -0.1 * double(k) : 0.1 * double(k) - 0.8, 1e-9)
          << method << " row " << k;
    }
  }
}

TEST(Decision, AnOutputOfTheModeInItsOwnLoopIsAnAlgebraicLoop) {
  EXPECT_PRED2(has, problems_of(diagram(R"("e": {"type": "DecidedSign", "in": {"u": "e.y"}})")),
               "algebraic loop");
}

TEST(Decision, OfEqualityIsNotReadAsAnExpression) {
  const RunResult result = run_of(diagram(R"("three": {"type": "Constant", "value": 3},
      "is_three": {"type": "Comparison", "operator": "==", "in": {"a": "three.y", "b": "three.y"}})"));
  EXPECT_EQ(signal(result, "is_three.y")[0], 1);
}

}  // namespace
}  // namespace loopwright::decision_test
