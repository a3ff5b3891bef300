// What only some runs of a sweep show: numbers from expressions inside the range of an axis, and combinations
// of values that a block refuses.
#include <gmock/gmock.h>
#include "tests/tools/sweep/sweep_testing.h"
#include "tools/sweep/lane_group.h"

namespace loopwright::combinations_test {
namespace {

using ::testing::HasSubstr;

std::string loop_with(const std::string& parameters, const std::string& blocks) {
  return fmt::format(R"({{"loopwright": 1, "solver": {{"method": "rk4", "step": 0.01, "stop": 0.02}},
    "parameters": {{{}}}, "blocks": {{"one": {{"type": "Constant", "value": 1.5}}, {}}}}})",
                     parameters, blocks);
}
const std::string limited =
    loop_with("", R"("limit": {"type": "Saturation", "low": 0, "high": 3, "in": {"u": "one.y"}})");

std::vector<double> metric_of(const SweepFolder& folder) {
  const SweepPlan plan = folder.plan();
  std::vector<double> values;
  for (const RunRecord& record : make_runs(plan, 0, plan.runs(), {})) {
    EXPECT_FALSE(record.failed) << record.reason;
    values.push_back(record.metrics[0]);
  }
  return values;
}

TEST(SweepCombinations, AnExpressionThatIsSpecialInsideTheRangeIsWorkedOutForEachRun) {
  const SweepFolder folder(R"("case": {"values": [1, 2, 3, 4, 5, 6, 7, 8]})", "", R"("g": {"final": "g.y"})",
                           loop_with(R"("case": 1, "chosen": "=case == 7 ? 5 : 1")",
                                     R"("g": {"type": "Gain", "gain": "=chosen", "in": {"u": "one.y"}})"));
  EXPECT_EQ(metric_of(folder), (std::vector<double>{1.5, 1.5, 1.5, 1.5, 1.5, 1.5, 7.5, 1.5}));
}

TEST(SweepCombinations, SoIsAnExpressionInASubdiagram) {
  SweepFolder folder(
      R"("case": {"values": [1, 2, 3, 4, 5, 6, 7, 8]})", "", R"("g": {"final": "part.y"})",
      loop_with(
          R"("case": 1)",
          R"("part": {"diagram": "part.json", "parameters": {"number": "=case"}, "in": {"u": "one.y"}})"));
  folder.folder.with("part.json", R"({"loopwright": 1, "parameters": {"number": 1}, "inputs": {"u": {}},
    "blocks": {"g": {"type": "Gain", "gain": "=number == 7 ? 5 : 1", "in": {"u": "u"}}}, "outputs": {"y": "g.y"}})");
  EXPECT_EQ(metric_of(folder), (std::vector<double>{1.5, 1.5, 1.5, 1.5, 1.5, 1.5, 7.5, 1.5}));
}

TEST(SweepCombinations, AStructuralExpressionInsideTheRangeGivesRunsTheirOwnPlans) {
  const SweepFolder folder(R"("case": {"values": [1, 2, 3, 4, 5, 6, 7, 8]})", "", R"("h": {"final": "h.y"})",
                           loop_with(R"("case": 1)", R"("ramp": {"type": "Clock"},
        "h": {"type": "ZeroOrderHold", "sample_time": "=case == 7 ? 0.02 : 0.01", "in": {"u": "ramp.time"}})"));
  const SweepPlan plan = folder.plan();
  EXPECT_THAT(plan.world(0).lanes_forbidden, HasSubstr("h.sample_time"));
}

TEST(SweepCombinations, APlainReferenceNeedsNoLoader) {
  const SweepFolder folder(R"("k": {"values": [1, 2, 3]})", "", R"("g": {"final": "g.y"})",
                           loop_with(R"("k": 1, "gain": "=k")",
                                     R"("g": {"type": "Gain", "gain": "=gain", "in": {"u": "one.y"}})"));
  EXPECT_FALSE(folder.plan().world(0).needs_loader);
  EXPECT_EQ(metric_of(folder), (std::vector<double>{1.5, 3, 4.5}));
}

TEST(SweepCombinations, OneThatABlockRefusesFailsAlone) {
  const SweepFolder folder(R"("limit.low": {"values": [0, 1, 2]}, "limit.high": {"values": [3, 1.8, 2.5]})",
                           "", R"("y": {"final": "limit.y"})", limited);
  const SweepPlan plan = folder.plan();
  const auto records = make_runs(plan, 0, plan.runs(), {});
  ASSERT_EQ(records.size(), 9u);
  for (const RunRecord& record : records) {
    const auto point = plan.design().point(record.run);
    EXPECT_EQ(record.failed, point[0] > point[1]) << point[0] << " " << point[1];
    if (record.failed)
      EXPECT_THAT(record.reason, HasSubstr("the lower limit lies above the upper one"));
    else
      EXPECT_EQ(record.metrics[0], std::clamp(1.5, point[0], point[1]));
  }
}

TEST(SweepCombinations, TheFirstRunMayBeTheRefusedOne) {
  const SweepFolder folder(R"("limit.low": {"values": [2, 0]}, "limit.high": {"values": [1, 3]})", "",
                           R"("y": {"final": "limit.y"})", limited);
  const SweepPlan plan = folder.plan();
  std::vector<bool> failed;
  for (const RunRecord& record : make_runs(plan, 0, plan.runs(), {})) failed.push_back(record.failed);
  EXPECT_EQ(failed, (std::vector<bool>{true, false, false, false}));
}

TEST(SweepCombinations, SamplesThatABlockRefusesDoNotRefuseTheSweep) {
  const SweepFolder folder(
      R"("limit.low": {"uniform": {"from": 0, "to": 2}}, "limit.high": {"uniform": {"from": 1, "to": 3}})",
      R"(, "samples": {"method": "sobol", "count": 64})", R"("y": {"final": "limit.y"})", limited);
  const SweepPlan plan = folder.plan();
  int failed = 0;
  for (const RunRecord& record : make_runs(plan, 0, plan.runs(), {})) {
    const auto point = plan.design().point(record.run);
    EXPECT_EQ(record.failed, point[0] > point[1]);
    failed += record.failed;
  }
  EXPECT_GT(failed, 0);
  EXPECT_LT(failed, 64);
}

TEST(SweepCombinations, AValueThatNeverFitsRefusesTheSweep) {
  const SweepFolder folder(R"("limit.low": {"values": [0, 5]}, "limit.high": {"values": [2, 3]})", "",
                           R"("y": {"final": "limit.y"})", limited);
  EXPECT_THAT(folder.problems(), HasSubstr("the lower limit lies above the upper one"));
}

}  // namespace
}  // namespace loopwright::combinations_test
