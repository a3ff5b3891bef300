// How long limits hold, against closed forms.
#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include <set>
#include "tests/tools/run/judged_diagram.h"

namespace loopwright::limits_test {
namespace {

using std::numbers::pi;

TEST(TimeAtLimits, IsAShareAndLeavesTheRecordingAlone) {
  const JudgedRun run = judged(limited_servo, R"(, "log": ["stage.position", "reference.y"])");
  std::vector<std::string> columns;
  for (const Column& column : run.result.recording.columns) columns.push_back(column.name);
  EXPECT_EQ(columns, (std::vector<std::string>{"time", "stage.position", "reference.y"}));
  ASSERT_EQ(run.figures.limits.size(), 1u);
  EXPECT_EQ(run.figures.limits[0].block, "limit");
  // The force is 1 N until x = 3/4 m: from 0.1 s on for sqrt(2·0.75/0.5) s.
  EXPECT_NEAR(run.figures.limits[0].high, std::sqrt(3.0) / 3, 0.002);
}

/// sin(2π t) over three periods, in two elements of a vector.
constexpr std::string_view two_sines = R"("s": {"type": "Sine", "amplitude": 1, "frequency": 1},
  "both": {"type": "Pack", "in": {"elements": ["s.y", "s.y"]}},)";

TEST(TimeAtLimits, OfEachElementOfAVectorWithItsOwnLimits) {
  const RunFigures figures =
      judged(std::string(two_sines) +
             R"("one": {"type": "Saturation", "low": -0.5, "high": 0.5, "in": {"u": "both.y"}},
  "own": {"type": "Saturation", "low": [-0.5, -2], "high": [0.5, 0.8], "in": {"u": "both.y"}})")
          .figures;
  // |sin| is above a for 1 - 2 asin(a)/π of the time, half of it on either side.
  const auto above = [](double a) { return 0.5 - std::asin(a) / pi; };
  ASSERT_EQ(figures.limits.size(), 4u);
  EXPECT_EQ(figures.limits_not_watched, 0u);
  const double expected[4][2] = {
      {above(0.5), above(0.5)}, {above(0.5), above(0.5)}, {above(0.5), above(0.5)}, {0, above(0.8)}};
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(figures.limits[i].low, expected[i][0], 0.002) << figures.limits[i].block;
    EXPECT_NEAR(figures.limits[i].high, expected[i][1], 0.002) << figures.limits[i].block;
  }
  EXPECT_EQ(figures.limits[3].block, "own[1]");
}

TEST(TimeAtLimits, OfLimitsInOtherUnitsAndExpressions) {
  const RunFigures figures =
      judged(R"("s": {"type": "Sine", "amplitude": {"value": 1, "unit": "A"}, "frequency": 1},
  "a": {"type": "Saturation", "low": {"value": -800, "unit": "mA"}, "high": {"value": 800, "unit": "mA"}, "in": {"u": "s.y"}},
  "b": {"type": "Saturation", "low": "=-most", "high": "=most", "in": {"u": "s.y"}})",
             R"(, "parameters": {"most": {"value": 800, "unit": "mA"}})")
          .figures;
  ASSERT_EQ(figures.limits.size(), 2u);
  for (const TimeAtLimit& limit : figures.limits)
    EXPECT_NEAR(limit.share(), 1 - 2 * std::asin(0.8) / pi, 0.003) << limit.block;
}

TEST(TimeAtLimits, AreNotThoseOfLevelsStopsZonesAndCounts) {
  const RunFigures figures =
      judged(
          R"("pulse": {"type": "PulseTrain", "period": 0.5, "width": 0.1, "low": 0, "high": 1},
  "zone": {"type": "DeadZone", "low": -1, "high": 1, "in": {"u": "pulse.y"}},
  "count": {"type": "Counter", "low": 0, "high": 2, "in": {"up": "pulse.y"}},
  "push": {"type": "Constant", "value": {"value": 1, "unit": "N"}},
  "net": {"type": "Sum", "signs": "+-", "in": {"terms": ["push.y", "stop.force"]}},
  "mass": {"type": "Mass", "mass": {"value": 1, "unit": "kg"}, "in": {"force": "net.sum"}},
  "stop": {"type": "EndStop", "low": {"value": -1, "unit": "m"}, "high": {"value": 0.1, "unit": "m"},
    "stiffness": {"value": 1000, "unit": "N/m"}, "damping": {"value": 60, "unit": "N*s/m"},
    "in": {"position": "mass.position", "velocity": "mass.velocity"}})")
          .figures;
  EXPECT_TRUE(figures.limits.empty()) << figures.limits[0].block;
}

TEST(TimeAtLimits, EveryBlockWithLowAndHighIsDecidedUpon) {
  // Whoever adds a block with parameters of these names decides here whether they hold its output.
  const std::set<std::string_view> others{"PulseTrain", "DeadZone", "EndStop", "Counter"};
  const auto has_number = [](const BlockInfo& info, std::string_view name) {
    const auto found = std::ranges::find(info.parameters, name, &ParameterInfo::name);
    return found != info.parameters.end() && found->tunable && found->kind == ParameterKind::number;
  };
  size_t limited = 0;
  for (const auto& [type, block] : all_blocks()) {
    const bool has_both = has_number(block.info, "low") && has_number(block.info, "high");
    const std::string_view output = limited_output(type);
    EXPECT_EQ(!output.empty(), has_both && !others.contains(type)) << type;
    if (output.empty()) continue;
    ++limited;
    EXPECT_NE(std::ranges::find(block.info.outputs, output, &PortInfo::name), block.info.outputs.end())
        << type;
  }
  EXPECT_EQ(limited, 7u);
}

TEST(TimeAtLimits, OfManyBlocksAreAllKnownAndTheLongestAreTold) {
  std::string blocks = R"("s": {"type": "Sine", "amplitude": 1, "frequency": 1})";
  for (int i = 0; i < 40; ++i)
    blocks += fmt::format(R"(, "b{}": {{"type": "Saturation", "high": {}, "in": {{"u": "s.y"}}}})", i,
                          0.99 - 0.01 * i);
  const JudgedRun run = judged(blocks);
  ASSERT_EQ(run.figures.limits.size(), 40u);
  EXPECT_GT(run.figures.limits.back().high, run.figures.limits.front().high);
  const std::string text = figures_text(run.figures);
  EXPECT_TRUE(has(text, "  b39 is at its limits")) << text;
  EXPECT_TRUE(has(text, "32 further blocks are at their limits")) << text;
  EXPECT_FALSE(has(text, "b0 is at its limits")) << text;
}

TEST(TimeAtLimits, ThatWereNotWatchedAreCounted) {
  // 1e8 rows leave room for no column: the blocks are counted, and nothing is recorded beside the log.
  const auto long_run = plan_of(diagram(limited_servo, R"("stop": 100000, "step": 0.001)",
                                        R"(, "log": ["stage.position", "reference.y"])"));
  const WatchedLimits watched(*long_run);
  EXPECT_EQ(watched.watched(), 0u);
  EXPECT_EQ(watched.left_out(), 1u);
  EXPECT_EQ(watched.plan().log.size(), 2u);

  DiagramFolder folder;
  RunOptions options;
  options.checkpoint_file = folder.path("run.checkpoint"), options.checkpoint_every = 1;
  const JudgedRun run = judged(limited_servo, "", options);
  EXPECT_TRUE(run.figures.limits.empty());
  EXPECT_EQ(run.figures.limits_not_watched, 1u);
  EXPECT_TRUE(has(figures_text(run.figures), "not watched: 1.")) << figures_text(run.figures);
}

}  // namespace
}  // namespace loopwright::limits_test
