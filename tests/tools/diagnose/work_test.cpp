// A search that ends at its limit of work says so, and ends there again, on every machine.
#include <Eigen/Dense>
#include <algorithm>
#include "tests/tools/diagnose/recorded_axis.h"
#include "tools/diagnose/diagnose.h"

namespace loopwright::work_test {
namespace {

Truth with_dry_friction() {
  Truth truth;
  truth.duration_s = 4;
  truth.force = [](double, double v, double) { return 0.1 * std::tanh(v / 1e-3); };
  return truth;
}

bool tells_of_the_limit(const Diagnosis& diagnosis) {
  return std::ranges::any_of(diagnosis.findings, [](const RecordFinding& f) {
    return f.what.starts_with("the search ended at its limit") && !f.cost.empty();
  });
}

TEST(Work, ASearchWithoutWorkNamesNothingAndSaysWhy) {
  const RecordedAxis axis(with_dry_friction());
  DiagnoseOptions options;
  options.most_work = 1;
  const Diagnosis short_of_work = diagnose(axis.diagram(), {axis.experiment()}, options);
  EXPECT_TRUE(tells_of_the_limit(short_of_work));
  EXPECT_TRUE(short_of_work.effects.empty());
  EXPECT_EQ(short_of_work.verdict, Verdict::unexplained) << "not: nothing is missing";
}

TEST(Work, ItIsCountedSoThatEveryRunEndsAlike) {
  const RecordedAxis axis(with_dry_friction());
  DiagnoseOptions options;
  options.most_work = 3e7;
  const Diagnosis once = diagnose(axis.diagram(), {axis.experiment()}, options);
  const Diagnosis again = diagnose(axis.diagram(), {axis.experiment()}, options);
  EXPECT_TRUE(tells_of_the_limit(once));
  EXPECT_EQ(to_json(once), to_json(again));
}

TEST(Work, AnOrdinaryRecordIsFarFromTheLimit) {
  const RecordedAxis axis(with_dry_friction());
  const Diagnosis diagnosis = diagnose(axis.diagram(), {axis.experiment()});
  EXPECT_FALSE(tells_of_the_limit(diagnosis));
  ASSERT_EQ(diagnosis.effects.size(), 1u);
  EXPECT_EQ(diagnosis.effects.front().name, "coulomb_friction");
}

/// Eigen would ask the processor: the same record then had other answers on another machine.
TEST(Work, SumsAreCutAlikeWhateverTheCachesOfTheProcessor) {
  EXPECT_EQ(Eigen::l1CacheSize(), 48 << 10);
  EXPECT_EQ(Eigen::l2CacheSize(), 2 << 20);
  EXPECT_EQ(Eigen::l3CacheSize(), 100 << 20);
}

}  // namespace
}  // namespace loopwright::work_test
