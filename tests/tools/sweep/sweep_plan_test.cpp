#include <gmock/gmock.h>
#include <cmath>
#include <set>
#include "tests/tools/sweep/sweep_testing.h"
#include "tools/sweep/sweep_page.h"
#include "tools/sweep/sensitivity.h"
#include "tools/sweep/tunables.h"

namespace loopwright::sweep_plan_test {
namespace {

using ::testing::HasSubstr;

TEST(SweepFile, TellsEveryProblemAtItsPlace) {
  DiagramFolder folder;
  folder.with("sweep.json", R"({
    "loopwright": 1, "diagramm": "loop.json",
    "axes": {"a.x": {"values": [1, "two"]}, "b": {"uniform": {"from": 2, "to": 1}}, "c": {}, "d": {"linear": {"from": 0, "to": 1}}},
    "paired": [["a.x", "a.y"]],
    "samples": {"method": "sobl", "count": 1.5},
    "metrics": {"m": {"rsm": "e"}, "n": {"settling_time": "e"}, "o": {"rms": "e", "band": 1}},
    "keep": "some"})");
  Problems problems;
  EXPECT_EQ(load_sweep(folder.path("sweep.json"), problems), nullptr);
  const std::string text = problems.text();
  for (const char* part :
       {"\"diagram\"", "\"from\" must lie below \"to\"", "the axis does not vary", "\"count\" is missing",
        "there is no axis \"a.y\"", "did you mean \"sobol\"", "no whole number",
        "the metric measures nothing", "\"band\" of \"settling_time\" is missing",
        "\"rms\" has no key \"band\"", "what shall be kept is not known", "sweep.json:3:"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST(SweepFile, RunsThatAreKeptHaveWholeNumbers) {
  DiagramFolder folder;
  folder.with("sweep.json", R"({"loopwright": 1, "diagram": "loop.json", "axes": {"a.x": {"values": [1]}},
    "metrics": {"m": {"rms": "e"}}, "keep": {"runs": [0, 1.5]}})");
  Problems problems;
  EXPECT_EQ(load_sweep(folder.path("sweep.json"), problems), nullptr);
  EXPECT_THAT(problems.text(), HasSubstr("the number of a run is no whole number"));
}

TEST(SweepPlan, PointsToTheAxisThatTheDiagramRefuses) {
  EXPECT_THAT(SweepFolder(R"("mas.mass": {"values": [1]})").problems(), HasSubstr("did you mean \"mass\""));
  const std::string range = SweepFolder(R"("mass.mass": {"values": [1, -2]})").problems();
  EXPECT_THAT(range, HasSubstr("out of range"));
  EXPECT_THAT(range, HasSubstr("sweep.json:1:"));
  EXPECT_THAT(SweepFolder(R"("pull.frequency": {"values": [1], "unit": "N"})").problems(),
              HasSubstr("sweep.json:1:"));
  EXPECT_THAT(
      SweepFolder(R"("mass.mass": {"values": [1]})", "", R"("m": {"rms": "mass.positon"})").problems(),
      HasSubstr("did you mean \"mass.position\""));
  EXPECT_THAT(SweepFolder(R"("mass.mass": {"values": [1]})", "",
                          R"("m": {"first_violation": "mass.position", "threshold": 1, "unit": "N"})")
                  .problems(),
              HasSubstr("another unit"));
}

/// Every tunable number of every run, whether it is tuned or that of the shared plan, is as the diagram gives
/// it.
void expect_numbers_of_all_runs(const SweepPlan& plan) {
  for (int64_t run = 0; run < plan.runs(); ++run) {
    const World& world = plan.world_of(run);
    auto numbers = tunable_numbers(*world.plan);
    const auto tuned = plan.tuned(run);
    for (size_t i = 0; i < tuned.size(); ++i) numbers.at(world.tuned[i]) = tuned[i];
    EXPECT_EQ(numbers, tunable_numbers(*plan.plan_of(run))) << "run " << run;
  }
}

TEST(SweepPlan, FollowsExpressionsAndUnits) {
  const SweepFolder folder(
      R"("stiffness": {"values": [10, 1000]}, "mass.mass": {"values": [500, 900], "unit": "g"})");
  const SweepPlan plan = folder.plan();
  const World& world = plan.world(0);
  EXPECT_TRUE(world.needs_loader);
  expect_numbers_of_all_runs(plan);
  EXPECT_EQ(world.tuned, (std::vector<std::string>{"damper.gain", "mass.mass", "spring.gain"}));
}

// Neither axis alone changes the damper from the first point. Only runs in between show that both do.
TEST(SweepPlan, NoticesWhatOnlyTwoAxesTogetherShow) {
  std::string loop = small_loop;
  loop.replace(loop.find("=2*damping_ratio*sqrt(stiffness)"), 32,
               "=damping_ratio > 0.5 && stiffness > 15 ? 3 : 1");
  const SweepFolder folder(
      R"("damping_ratio": {"values": [0.1, 0.9]}, "stiffness": {"values": [10, 20, 30]})", "",
      metrics_of_all_kinds, loop);
  expect_numbers_of_all_runs(folder.plan());
}

// Only one run of 200 shows that the damper depends on the axes, through two parameters.
TEST(SweepPlan, NoticesWhatASingleRunShows) {
  std::string loop = small_loop;
  loop.replace(loop.find("=2*damping_ratio*sqrt(stiffness)"), 32, "=handed_on");
  loop.replace(loop.find("\"stiffness\": 40"), 15,
               R"("stiffness": 40, "handed_on": "=chosen",
                  "chosen": "=damping_ratio > 0.5 && stiffness == 15 ? 3 : 1")");
  const SweepFolder folder(
      R"("damping_ratio": {"values": [0.1, 0.9]}, "stiffness": {"linear": {"from": 10, "to": 109, "count": 100}})",
      "", metrics_of_all_kinds, loop);
  const SweepPlan plan = folder.plan();
  expect_numbers_of_all_runs(plan);
  std::set<double> dampers;
  for (int64_t run = 0; run < plan.runs(); ++run)
    dampers.insert(tunable_numbers(*plan.plan_of(run)).at("damper.gain"));
  EXPECT_EQ(dampers, (std::set<double>{1, 3}));
}

TEST(SweepPlan, GivesVariantsAndStructuralValuesPlansOfTheirOwn) {
  std::string loop = small_loop;
  const std::string gain = R"({"type": "Gain", "gain": "=stiffness", "in": {"u": "mass.position"}})";
  loop.replace(
      loop.find(gain), gain.size(),
      R"({"variants": {"soft": {"type": "Gain", "gain": 10}, "hard": {"type": "Gain", "gain": "=stiffness"}}, "variant": "soft", "in": {"u": "mass.position"}})");
  const SweepFolder folder(
      R"("mass.mass": {"values": [1, 2, 3]}, "spring": {"variants": ["soft", "hard"]}, "noise.sample_time": {"values": [0.05, 0.1]})",
      "", metrics_of_all_kinds, loop);
  const SweepPlan plan = folder.plan();
  EXPECT_EQ(plan.design().worlds(), 4);
  EXPECT_EQ(plan.runs(), 12);
  run_sweep(plan, folder.results(), {});
  const SweepResults results = read_results(plan, folder.results());
  std::set<double> distinct(results.table.find("f")->values.begin(), results.table.find("f")->values.end());
  EXPECT_EQ(distinct.size(), 12u);
  EXPECT_THAT(plan.command(11), HasSubstr("--variant 'spring=hard'"));
}

TEST(SweepDesign, PairsAxesAndCountsTheLastFastest) {
  const SweepFolder folder(
      R"("mass.mass": {"values": [1, 2]}, "stiffness": {"values": [10, 20, 30]}, "pull.frequency": {"values": [3, 4]})",
      R"(, "paired": [["mass.mass", "pull.frequency"]])");
  const SweepPlan plan = folder.plan();
  ASSERT_EQ(plan.runs(), 6);
  EXPECT_EQ(plan.design().point(1), (std::vector<double>{1, 20, 3}));
  EXPECT_EQ(plan.design().point(5), (std::vector<double>{2, 30, 4}));
}

TEST(SweepDesign, FillsEveryStratumOfALatinHypercubeOnce) {
  for (const int count : {1, 2, 7, 64, 1000}) {
    const SweepFolder folder(
        R"("mass.mass": {"uniform": {"from": 1, "to": 2}}, "pull.frequency": {"uniform": {"from": 1, "to": 2}})",
        fmt::format(R"(, "samples": {{"method": "latin_hypercube", "count": {}}})", count));
    const SweepPlan plan = folder.plan();
    std::vector<std::set<int>> strata(2);
    for (int64_t run = 0; run < count; ++run)
      for (size_t a = 0; a < 2; ++a) strata[a].insert(int((plan.design().point(run)[a] - 1) * count));
    EXPECT_EQ(strata[0].size(), size_t(count));
    EXPECT_EQ(strata[1].size(), size_t(count));
  }
}

TEST(SweepDesign, SamplesEachDistributionAsStated) {
  const SweepFolder folder(
      R"("mass.mass": {"normal": {"mean": 5, "deviation": 0.5}}, "stiffness": {"log_uniform": {"from": 1, "to": 10000}})",
      R"(, "samples": {"method": "sobol", "count": 4096})");
  const SweepPlan plan = folder.plan();
  double sum = 0, squares = 0, below = 0;
  for (int64_t run = 0; run < plan.runs(); ++run) {
    const auto point = plan.design().point(run);
    sum += point[0], squares += (point[0] - 5) * (point[0] - 5), below += point[1] < 100;
  }
  EXPECT_NEAR(sum / 4096, 5, 1e-3);
  EXPECT_NEAR(std::sqrt(squares / 4096), 0.5, 5e-3);
  EXPECT_NEAR(below / 4096, 0.5, 2e-3);
}

// Known in closed form: the indices of the Ishigami function with a = 7, b = 0.1.
TEST(Sensitivity, FindsTheIndicesOfTheIshigamiFunction) {
  const char* const loop = R"json({"loopwright": 1, "solver": {"stop": 0.1, "step": 0.1}, "blocks": {
    "x1": {"type": "Constant", "value": 0}, "x2": {"type": "Constant", "value": 0}, "x3": {"type": "Constant", "value": 0},
    "y": {"type": "Expression", "formula": "sin(a) + 7*sin(b)^2 + 0.1*c^4*sin(a)", "names": ["a", "b", "c"],
          "in": {"arguments": ["x1.y", "x2.y", "x3.y"]}}}, "log": ["y.y"]})json";
  const std::string range = fmt::format(R"({{"uniform": {{"from": -{0}, "to": {0}}}}})", M_PI);
  const SweepFolder folder(fmt::format(R"("x1.value": {0}, "x2.value": {0}, "x3.value": {0})", range),
                           R"(, "samples": {"method": "saltelli", "count": 1024})",
                           R"("y": {"final": "y.y"})", loop);
  const SweepPlan plan = folder.plan();
  run_sweep(plan, folder.results(), {});
  const auto effects = effects_of(plan, read_results(plan, folder.results()).table, 0);
  EXPECT_NEAR(effects[0].first_order, 0.3139, 0.03);
  EXPECT_NEAR(effects[1].first_order, 0.4424, 0.03);
  EXPECT_NEAR(effects[2].first_order, 0.0, 0.03);
  EXPECT_NEAR(effects[0].total.value(), 0.5576, 0.03);
  EXPECT_NEAR(effects[1].total.value(), 0.4424, 0.03);
  EXPECT_NEAR(effects[2].total.value(), 0.2437, 0.03);
  const double first_order[] = {0.3139, 0.4424, 0.0}, total[] = {0.5576, 0.4424, 0.2437};
  for (int a = 0; a < 3; ++a) {  // the stated errors are those of the estimates
    EXPECT_GT(effects[size_t(a)].first_order_error, 0.005);
    EXPECT_LT(effects[size_t(a)].first_order_error, 0.06);
    EXPECT_NEAR(effects[size_t(a)].first_order, first_order[a], 3 * effects[size_t(a)].first_order_error);
    EXPECT_NEAR(effects[size_t(a)].total.value(), total[a], 3 * effects[size_t(a)].total_error);
  }
  bool is_shown = false;
  for (const report::Section& section : sweep_page(plan, read_results(plan, folder.results()), {}).sections)
    for (const report::Item& item : section.items)
      if (const auto* table = std::get_if<report::Table>(&item); table && table->head[0] == "Axis")
        for (const auto& row : table->rows)
          if (row[0] == "x3.value" && table->head[1] == "First-order index") {
            EXPECT_TRUE(row[1].starts_with("< 0.")) << "an index below its error is no number: " << row[1];
            EXPECT_NE(row[2].find(" ± 0.0"), row[2].npos) << row[2];
            is_shown = true;
          }
  EXPECT_TRUE(is_shown);
}

}  // namespace
}  // namespace loopwright::sweep_plan_test
