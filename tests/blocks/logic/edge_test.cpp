#include <gmock/gmock.h>
#include <random>
#include "tests/blocks/block_under_test.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::edge_test {
namespace {

TEST(Edge, IsTheDifferenceOfTwoSamples) {
  std::mt19937_64 random(1);
  BlockUnderTest rising("Edge", "{}", 0.001), falling("Edge", R"({"edge": "falling"})", 0.001),
      either("Edge", R"({"edge": "either"})", 0.001);
  int last = 0;
  for (int k = 0; k < 1000; ++k) {
    const int now = int(random() % 2), change = k == 0 ? 0 : now - last;
    EXPECT_EQ(rising.sample("u", now, "y"), change > 0) << k;
    EXPECT_EQ(falling.sample("u", now, "y"), change < 0) << k;
    EXPECT_EQ(either.sample("u", now, "y"), change != 0) << k;
    last = now;
  }
}

TEST(Edge, TheFirstSampleIsNone) {
  BlockUnderTest edge("Edge", R"({"edge": "either"})", 0.001);
  EXPECT_EQ(edge.sample("u", 1, "y"), 0);
  edge.restart();
  EXPECT_EQ(edge.sample("u", 0, "y"), 0);
}

TEST(Edge, StopsAtNaN) {
  BlockUnderTest edge("Edge", "{}", 0.001);
  edge.sample("u", std::nan(""), "y");
  EXPECT_THAT(std::string(edge.fault()), testing::HasSubstr("NaN"));
}

TEST(Edge, IsSampledOnly) {
  const std::string text =
      problems_of(diagram(R"("s": {"type": "Step"}, "e": {"type": "Edge", "in": {"u": "s.y"}})"));
  EXPECT_THAT(text, testing::HasSubstr("sample_time"));
}

TEST(Edge, SeesEachRiseOnceAtAnyOffset) {
  for (const char* offset : {"0", "0.004", "0.009"}) {
    const RunResult result = run_of(diagram(
        fmt::format(R"("pulses": {{"type": "PulseTrain", "period": 0.1, "width": 0.05, "start": 0.033}},
          "edge": {{"type": "Edge", "sample_time": 0.01, "sample_offset": {}, "in": {{"u": "pulses.y"}}}},
          "sum": {{"type": "DiscreteIntegrator", "method": "backward", "sample_time": 0.01, "sample_offset": {},
                  "in": {{"u": "edge.y"}}}})",
                    offset, offset),
        R"("stop": 1, "step": 0.001)"));
    EXPECT_NEAR(signal(result, "sum.y").back(), 0.01 * 10, 1e-12)
        << "ten rises, each a sample long, offset " << offset;
  }
}

}  // namespace
}  // namespace loopwright::edge_test
