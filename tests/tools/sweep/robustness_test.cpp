#include "tools/sweep/robustness.h"
#include <gmock/gmock.h>
#include <cmath>
#include "tests/tools/sweep/sweep_testing.h"

namespace loopwright::robustness_test {
namespace {

using ::testing::HasSubstr;

/// y = 2 of the variant `steady`, y = a of `following`. Beyond a = 3 the latter divides by zero.
const char* const two_variants = R"json({
  "loopwright": 1, "solver": {"stop": 0.1, "step": 0.1}, "parameters": {"a": 1, "b": 1},
  "blocks": {
    "a": {"type": "Constant", "value": "=a"}, "b": {"type": "Constant", "value": "=b"},
    "y": {"variants": {"steady": {"type": "Expression", "formula": "2 + 0*a*b", "names": ["a", "b"]},
                       "following": {"type": "Expression", "formula": "a > 3.5 ? 1/0 : a*b", "names": ["a", "b"]}},
          "in": {"arguments": ["a.y", "b.y"]}}}, "log": ["y.y"]})json";

struct Sweeps {
  SweepFolder folder{R"("y": {"variants": ["steady", "following"]}, "a": {"values": [1, 2, 3, 4]},
                        "b": {"values": [1, 2, 3]})",
                     "", R"("y": {"final": "y.y"})", two_variants};
  SweepPlan plan = folder.plan();
  SweepResults results;
  Sweeps() {
    run_sweep(plan, folder.results(), {});
    results = read_results(plan, folder.results());
  }
};

TEST(Robustness, IsFlatWhereAVariantDoesNotHangOnAnAxis) {
  const Sweeps sweeps;
  const auto profiles = profiles_of(sweeps.plan, sweeps.results.table, 0, 0);
  ASSERT_EQ(profiles.size(), 2u);  // of a and b
  ASSERT_EQ(profiles[0].spread.size(), 2u);
  ASSERT_EQ(profiles[0].spread[0].size(), 4u);
  for (const Spread& s : profiles[0].spread[0]) {
    EXPECT_EQ(s.low, 2);
    EXPECT_EQ(s.median, 2);
    EXPECT_EQ(s.high, 2);
  }
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(profiles[0].spread[1][i].median, 2 * double(i + 1));  // b = 2 in the middle
    EXPECT_EQ(profiles[0].spread[1][i].from, double(i + 1));
  }
}

TEST(Robustness, TakesARunThatFailedAsInfinite) {
  const Sweeps sweeps;
  const auto profiles = profiles_of(sweeps.plan, sweeps.results.table, 0, 0);
  EXPECT_TRUE(std::isinf(profiles[0].spread[1][3].median));
  EXPECT_EQ(profiles[0].spread[0][3].median, 2);
  const auto table = robustness_table(sweeps.plan, sweeps.results.table, 0, 0);
  EXPECT_EQ(table.rows[0][4], "1.00");
  EXPECT_EQ(table.rows[1][3], "inf");
}

TEST(Robustness, DrawsAPanelForEveryAxisAndACurveForEveryVariant) {
  const Sweeps sweeps;
  const std::string svg = robustness_picture(sweeps.plan, sweeps.results.table, 0, 0).svg;
  size_t curves = 0;
  for (size_t at = svg.find("<polyline"); at != svg.npos; at = svg.find("<polyline", at + 1)) ++curves;
  EXPECT_EQ(curves, 4u);
  for (const char* name : {"steady", "following", ">a<", ">b<"}) EXPECT_THAT(svg, HasSubstr(name));
  EXPECT_EQ(svg.find("nan"), svg.npos);
}

}  // namespace
}  // namespace loopwright::robustness_test
