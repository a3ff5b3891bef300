// A slow disturbance that follows a signal is an effect, and no noise.
#include "tools/diagnose/verdict/followed_signal.h"
#include <gmock/gmock.h>
#include <cmath>
#include "tests/tools/diagnose/diagnosed_plant.h"
#include "tools/diagnose/search/site_disturbance.h"
#include "tools/diagnose/search/site_start.h"
#include "tools/diagnose/verdict/smooth_share.h"

namespace loopwright::followed_signal_test {
namespace {

using namespace diagnosis;

/// Of the slow disturbance that the nominal diagram needs, where a period has two hundred rows.
std::optional<FollowedSignal> followed(Plant plant) {
  plant.sample_time = 1.5e-3, plant.measurement_noise = {1e-6}, plant.process_noise = {0.02};
  const RecordedPlant files(plant);
  SiteModel model(files.diagram(), {files.experiment()}, {});
  SiteFilter filter(model);
  SiteFitter fitter(filter, model.record().held_out_from, [] { return false; });
  SiteHypothesis nominal;
  EXPECT_TRUE(start_from_stated(fitter, ErrorsOf::predictions, {}, nominal));
  const SiteHypothesis h = with_disturbances(fitter, nominal, 1);
  EXPECT_EQ(h.noise.slow.size(), 1u);
  return h.noise.slow.empty() ? std::nullopt : followed_signal(fitter, h, 0);
}

TEST(FollowedSignal, AForceOfThePositionIsSeenInTheDisturbance) {
  Oscillator m;
  m.force = [](double x, double) { return 0.5 * std::cos(60 * x); };
  const auto signal = followed(oscillator(m, 71));
  ASSERT_TRUE(signal);
  EXPECT_THAT(signal->name,
              testing::StartsWith("mass.position"));  // late, the estimate is one of the direction too
  EXPECT_GT(signal->share, 0.35);
}
TEST(FollowedSignal, ADryFrictionThatChangesWithThePositionFollowsItAndTheDirection) {
  Oscillator m;
  m.force = [](double x, double v) { return 0.5 * std::tanh(v / 0.1) * std::cos(40 * x); };
  const auto signal = followed(oscillator(m, 72));
  ASSERT_TRUE(signal);
  EXPECT_EQ(signal->name, "mass.position and the direction of mass.velocity");
}
TEST(FollowedSignal, NoiseFollowsNone) {
  for (uint64_t seed = 73; seed < 78; ++seed) {
    Plant plant = oscillator({}, seed);
    plant.slow_noise = {0.5};
    EXPECT_FALSE(followed(plant)) << seed;
  }
}

/// A mean is a function of any signal: of a disturbance that lasts a tenth of the record much of it is mean.
TEST(FollowedSignal, NoiseThatLastsFollowsNone) {
  for (uint64_t seed = 81; seed < 87; ++seed) {
    Plant plant = oscillator({}, seed);
    plant.slow_noise = {0.5}, plant.slow_samples = 400;
    EXPECT_FALSE(followed(plant)) << seed;
  }
}

TEST(SmoothShare, IsThatOfRowsToWhichTheFunctionWasNotFitted) {
  std::vector<double> x, bent, sided, side, other;
  for (size_t k = 0; k < 1000; ++k) {
    x.push_back(std::sin(0.05 * double(k))), side.push_back(std::cos(0.05 * double(k)));
    bent.push_back(x.back() * x.back()), sided.push_back(side.back() < 0 ? -1 : 1);
    other.push_back(std::sin(0.7 * double(k)));
  }
  EXPECT_GT(smooth_share(bent, x, 12, 50), 0.98);
  EXPECT_LT(smooth_share(sided, x, 12, 50), 0.05);
  EXPECT_GT(smooth_share(sided, x, 12, 50, side), 0.98);
  EXPECT_LT(smooth_share(other, x, 12, 50), 0.05);
}

}  // namespace
}  // namespace loopwright::followed_signal_test
