#include <gtest/gtest.h>
#include <limits>
#include "tests/blocks/block_under_test.h"

namespace loopwright::enable_test {
namespace {

/// The output of an Enable block of this kind for a sequence of values.
std::vector<double> enabled(const char* settings, const std::vector<double>& values) {
  BlockUnderTest enable("Enable", settings);
  std::vector<double> on;
  double time = 0;
  for (const double value : values) {
    enable.input("u") = value;
    enable.evaluate(time += 0.1);
    on.push_back(enable.output("on"));
  }
  return on;
}

TEST(Enable, FollowsTheLevelOrTheEdges) {
  const std::vector<double> values = {1, 1, 0.5, 0.6, 0, 0, 1};
  using Outputs = std::vector<double>;
  EXPECT_EQ(enabled("{}", values), (Outputs{1, 1, 0, 1, 0, 0, 1}));
  EXPECT_EQ(enabled(R"({"kind": "rising"})", values), (Outputs{0, 0, 0, 1, 0, 0, 1}))
      << "the first value is no edge";
  EXPECT_EQ(enabled(R"({"kind": "falling"})", values), (Outputs{0, 0, 1, 0, 1, 0, 0}));
  EXPECT_EQ(enabled(R"({"kind": "either"})", values), (Outputs{0, 0, 1, 1, 1, 0, 1}));
}

TEST(Enable, AnEdgeLastsForItsInstant) {
  BlockUnderTest enable("Enable", R"({"kind": "rising"})");
  const auto on_at = [&](double time, double u) {
    enable.input("u") = u;
    enable.evaluate(time);
    return enable.output("on");
  };
  EXPECT_EQ(on_at(0, 0), 0);
  EXPECT_EQ(on_at(1, 1), 1);
  EXPECT_EQ(on_at(1, 1), 1) << "decided again after a jump";
  EXPECT_EQ(on_at(1, 0), 1) << "also if the jump takes the signal back";
  EXPECT_EQ(on_at(2, 0), 0);
}

TEST(EnabledOutput, IsZeroWhileTheSubdiagramDoesNotRun) {
  BlockUnderTest output("EnabledOutput");
  for (const double u : {3.0, -2.0, std::numeric_limits<double>::quiet_NaN()}) {
    output.input("u") = u, output.input("on") = 0;
    output.evaluate();
    EXPECT_EQ(output.output("y"), 0);
  }
  output.input("u") = -2, output.input("on") = 1;
  output.evaluate();
  EXPECT_EQ(output.output("y"), -2);
}

}  // namespace
}  // namespace loopwright::enable_test
