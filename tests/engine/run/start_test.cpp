// Values of signals before their first sample.
#include <gtest/gtest.h>
#include "tests/engine/written_diagram.h"

namespace loopwright::start_test {
namespace {

TEST(Start, WhatReadsAHeldBlockIsComputedFromItsInitialValue) {
  const RunResult result =
      run_of(diagram(R"("c": {"type": "Constant", "value": 5},
    "z": {"type": "ZeroOrderHold", "sample_time": 0.2, "sample_offset": 0.1, "in": {"u": "c.y"}},
    "s": {"type": "Sum", "signs": "++", "in": {"terms": ["z.y", "c.y"]}},
    "g": {"type": "Gain", "gain": 2, "in": {"u": "s.sum"}})",
                     R"("method": "rk4", "step": 0.01, "stop": 0.5, "record_step": 0.05)"));
  for (size_t row = 0; row < result.recording.rows(); ++row) {
    const double held = row < 2 ? 0 : 5;
    EXPECT_EQ(signal(result, "z.y")[row], held) << row;
    EXPECT_EQ(signal(result, "s.sum")[row], held + 5) << row;
    EXPECT_EQ(signal(result, "g.y")[row], 2 * (held + 5)) << row;
  }
}

TEST(Start, AMemoryShowsItsInitialValueBeforeItsFirstSample) {
  const std::string blocks = R"("t": {"type": "Clock"},
    "d": {"type": "UnitDelay", "initial": 3, "sample_time": 0.2, "sample_offset": 0.1, "in": {"u": "t.time"}},
    "g": {"type": "Gain", "gain": {"value": 2, "unit": "1"}, "in": {"u": "d.y"}})";
  for (const char* method : {R"("step": 0.05)", R"("method": "dopri5")"}) {
    const RunResult result =
        run_of(diagram(blocks, fmt::format(R"("stop": 1, "record_step": 0.05, {})", method)));
    for (size_t row = 0; row < 2; ++row) {
      EXPECT_EQ(signal(result, "d.y")[row], 3) << method << row;
      EXPECT_EQ(signal(result, "g.y")[row], 6) << method << row;
    }
    EXPECT_EQ(signal(result, "d.y")[2], 3) << "the first sample";
    EXPECT_EQ(signal(result, "d.y")[6], 0.1) << "what the first sample took";
  }
}

TEST(Start, ThatIsNoMultipleOfASampleTimeIsTheSame) {
  const RunResult result = run_of(diagram(R"("c": {"type": "Constant", "value": 5},
    "d": {"type": "UnitDelay", "initial": 3, "sample_time": 0.2, "in": {"u": "c.y"}},
    "s": {"type": "Sum", "in": {"terms": ["d.y", "c.y"]}})",
                                          R"("start": 0.05, "stop": 1, "step": 0.05, "record_step": 0.05)"));
  EXPECT_EQ(signal(result, "d.y")[0], 3);
  EXPECT_EQ(signal(result, "s.sum")[0], 8);
  EXPECT_EQ(signal(result, "s.sum")[2], 8);
  EXPECT_EQ(signal(result, "s.sum").back(), 10);
}

}  // namespace
}  // namespace loopwright::start_test
