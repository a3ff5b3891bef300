#include "tools/effects/motion.h"
#include <gtest/gtest.h>
#include <cmath>
#include "tests/tools/effects/axis_sizes.h"

namespace loopwright::motion_test {

TEST(Motion, EveryExperimentOfTheCatalogueCanBeRun) {
  const RecordSizes sizes = axis_sizes();
  for (const Effect& effect : whole_catalogue())
    for (const ConfusableEffect& other : effect.confusable) {
      const Motion motion = motion_of(other.experiment, sizes);
      const std::string name = effect.name + " or " + other.with;
      ASSERT_GT(motion.position.size(), 100u) << name;
      ASSERT_LT(motion.position.size(), 400000u) << name;
      double fastest = 0, hardest = 0, wanted = 0;
      for (double speed : other.experiment.speeds) wanted = std::max(wanted, speed * sizes.top_speed);
      for (size_t k = 1; k + 1 < motion.position.size(); ++k) {
        const double before = motion.position[k - 1], here = motion.position[k],
                     after = motion.position[k + 1];
        fastest = std::max(fastest, std::abs(after - here) / 1e-3);
        hardest = std::max(hardest, std::abs(after - 2 * here + before) / 1e-6);
      }
      EXPECT_LE(fastest, 1.001 * wanted) << name;
      EXPECT_LE(hardest, 1.1 * other.experiment.acceleration * sizes.top_acceleration) << name;
      EXPECT_NEAR(motion.position.back(), motion.position.front(), 1e-9) << name;
    }
}

TEST(Motion, ReachesItsSpeedsBothWays) {
  SeparatingExperiment experiment;
  experiment.speeds = {0.25, 1};
  const Motion motion = motion_of(experiment, axis_sizes());
  for (double speed : {0.1, -0.1, 0.4, -0.4}) {
    int samples = 0;
    for (size_t k = 1; k < motion.position.size(); ++k)
      samples += std::abs((motion.position[k] - motion.position[k - 1]) / 1e-3 - speed) < 1e-6;
    EXPECT_GT(samples, 1000) << speed;
  }
}

}  // namespace loopwright::motion_test
