// Edges at an instant at which a state jumps: the signals are computed again there, and the edge must last.
#include <gtest/gtest.h>
#include <cmath>
#include "tests/engine/written_diagram.h"

namespace loopwright::trigger_test {
namespace {

/// A sampled pulse with edges up at 1 s, 3 s and 5 s triggers an integrator of 1 by samples of 0.1 s. The
/// same pulse resets `x`, or does not.
RunResult with_reset(bool resets, std::string_view method) {
  return run_of(diagram(
      fmt::format(R"("t": {{"type": "PulseTrain", "period": 2, "width": 1, "start": 1, "sample_time": 0.1}},
    "one": {{"type": "Constant", "value": 1}}, "enable": {{"type": "Enable", "kind": "rising", "in": {{"u": "t.y"}}}},
    "count": {{"diagram": {{"inputs": {{"u": "1"}}, "outputs": {{"y": "d.y"}}, "blocks": {{
      "d": {{"type": "DiscreteIntegrator", "method": "backward", "sample_time": 0.1, "in": {{"u": "u"}}}}}}}},
      "triggered_by": "t.y", "in": {{"u": "one.y"}}}},
    "x": {{"type": "Integrator", "in": {{"u": "one.y"{}}}}})",
                  resets ? R"(, "reset": "t.y")" : ""),
      fmt::format(R"("method": {}, "stop": 6, "record_step": 0.1)", method)));
}

TEST(Trigger, IsNotLostWhereAStateJumpsAtTheSameInstant) {
  for (const char* method : {R"("rk4", "step": 0.1)", R"("dopri5")"})
    for (const bool resets : {false, true}) {
      const RunResult result = with_reset(resets, method);
      ASSERT_EQ(result.status, RunStatus::finished) << method << result.message;
      for (size_t i = 0; i < result.recording.rows(); ++i) {
        const auto tick = int64_t(std::lround(10 * signal(result, "time")[i]));
        const bool is_edge = tick >= 10 && (tick - 10) % 20 == 0;
        const double edges = tick < 10 ? 0 : double((tick - 10) / 20 + 1);
        EXPECT_EQ(signal(result, "enable.on")[i], is_edge) << method << resets << " tick " << tick;
        EXPECT_NEAR(signal(result, "count.y")[i], 0.1 * edges, 1e-12) << method << resets << " tick " << tick;
      }
    }
}

}  // namespace
}  // namespace loopwright::trigger_test
