// The published model of EMPS, compared with its published measurement.
#include <gtest/gtest.h>
#include <cstdlib>
#include <filesystem>
#include "tests/tools/experiment/experiment_folder.h"
#include "where.h"

namespace loopwright::emps_test {
namespace {

TEST(Emps, ThePublishedParametersReproduceTheRecordedLoop) {
  // A. Janot, M. Gautier, M. Brunot, Data Set and Reference Models of EMPS, 2019: force within 5.5 % of its
  // magnitude.
  setenv("LOOPWRIGHT_DATA", LOOPWRIGHT_SOURCE "/../shared/data", 0);
  if (!std::filesystem::exists(std::string(std::getenv("LOOPWRIGHT_DATA")) + "/emps/emps_train.csv"))
    GTEST_SKIP() << "no emps/emps_train.csv below $LOOPWRIGHT_DATA";
  const Comparison c = compare(LOOPWRIGHT_SOURCE "/diagrams/emps/published.json",
                               LOOPWRIGHT_SOURCE "/diagrams/emps/closed_loop.experiment.json");
  ASSERT_EQ(c.run.status, RunStatus::finished) << c.run.message;
  EXPECT_EQ(c.time.size(), 24841u);
  ASSERT_EQ(c.signals.size(), 2u);
  const ComparedSignal &position = c.signals[0], &force = c.signals[1];
  EXPECT_EQ(position.name, "axis.position");
  EXPECT_LE(position.rmse, 2.0e-6) << "m";
  EXPECT_EQ(position.resolution, 5e-8);
  EXPECT_EQ(force.name, "controller.force");
  EXPECT_LE(force.relative_percent, 5.5);
}

}  // namespace
}  // namespace loopwright::emps_test
