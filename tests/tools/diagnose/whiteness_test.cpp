// What the counts of a sensor excuse.
#include "tools/diagnose/search/whiteness.h"
#include <cmath>
#include "models/random/philox.h"
#include "models/statistics/portmanteau.h"
#include "tests/tools/diagnose/flawed_axis.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/prepare.h"

namespace loopwright::diagnosis::whiteness_test {
namespace {

/// What the counts of a clean record add, if the force noise is taken to be this much larger than it is.
double excuse(const FlawedMachine& machine, double force_noise) {
  const FlawedAxis axis(machine);
  Motion motion;
  Trials trials = prepare(axis.diagram(), {axis.experiment()}, {}, motion);
  trials.run_along(Trials::Rows::fitted);
  motion = cut(motion, trials);
  Noise noise = trials.noise;
  noise.white = force_noise * machine.force_noise;
  const Estimate estimate = fit_members(trials, {}, noise, motion, 0);
  return portmanteau_of_counts(trials, errors_of_counts(trials, estimate));
}

/// Dozens of counts a sample are white. Whatever else makes the errors large, as a load behind a gap does, is
/// no matter of the counts.
TEST(Counts, OfFastMotionExcuseNothing) {
  FlawedMachine machine;
  machine.resolution = 5e-6, machine.sensor_noise = 0;
  machine.stroke = 2, machine.top_speed = 3;
  for (const double force_noise : {1.0, 5.0, 25.0})
    EXPECT_LT(criteria::reach_of_counts * excuse(machine, force_noise), criteria::most_portmanteau_of_counted)
        << force_noise;
}
TEST(Counts, OfASteadyCrawlExcuseTheirBeat) {
  FlawedMachine machine;
  machine.resolution = 1e-4, machine.sensor_noise = 0;
  machine.steady_speeds = {0.978e-1, 0.326};
  EXPECT_GT(excuse(machine, 1), 1000);
}
TEST(Counts, WithoutAResolutionThereAreNone) {
  FlawedMachine machine;
  machine.resolution = 0;
  EXPECT_EQ(excuse(machine, 1), 0);
}

/// Rows that are left out take pairs from the lags, not their weight.
TEST(Portmanteau, OfWhiteErrorsIsTheNumberOfLagsWhateverRowsAreLeftOut) {
  const FlawedAxis axis(FlawedMachine{});
  Motion motion;
  Trials trials = prepare(axis.diagram(), {axis.experiment()}, {}, motion);
  std::vector<Fitted> fitted(1);
  const size_t rows = trials.list[0].usable.size();
  for (size_t k = 0; k < rows * trials.ports(); ++k)
    fitted[0].white.push_back(std::sqrt(12.0) * (uniform_pair(7, 1, k).first - 0.5));
  const double lags = double(criteria::portmanteau_lags);
  for (const size_t stretch : {size_t(20), size_t(50), rows}) {
    for (size_t k = 0; k < rows; ++k) trials.list[0].usable[k] = k / stretch % 2 == 0;
    const LaggedProducts products = lagged_products(trials, fitted, 0, 1);
    EXPECT_NEAR(loopwright::portmanteau(products.sum, products.rows), lags, 3 * std::sqrt(2 * lags))
        << stretch;
  }
}

}  // namespace
}  // namespace loopwright::diagnosis::whiteness_test
