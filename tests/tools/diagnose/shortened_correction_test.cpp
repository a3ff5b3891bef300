// A correction of the filter that leads where no state can be is taken in part. What replays a pass takes the
// same part.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include "tests/tools/diagnose/plants.h"
#include "tools/diagnose/search/site_fit.h"
#include "tools/diagnose/search/site_start.h"

namespace loopwright::shortened_correction_test {
namespace {

using namespace diagnosis;

/// Tanks that are nearly empty most of the time: the noise of a reading asks for levels below zero, of which
/// the diagram has no root.
Plant nearly_empty_tanks() {
  Plant plant = tanks(Tanks{}, 63);
  const std::string with_abs = "sqrt(abs(h))";
  for (size_t at = 0; (at = plant.diagram.find(with_abs, at)) != std::string::npos;)
    plant.diagram.replace(at, with_abs.size(), "sqrt(h)");
  plant.process_noise = {1.5e-4, 1.5e-4}, plant.measurement_noise = {2e-3, 2e-3}, plant.rows = 1200;
  plant.input = [](double t) { return std::fmod(t, 800) < 120 ? 4.0 : 0.05; };
  plant.rate = [rate = plant.rate](const Numbers& x, double u, const Numbers& w) {
    return rate({std::max(0.0, x[0]), std::max(0.0, x[1])}, u, w);
  };
  return plant;
}

class ShortenedCorrection : public testing::Test {
 protected:
  ShortenedCorrection() {
    EXPECT_TRUE(start_from_stated(fitter, ErrorsOf::predictions, {}, found));
    EXPECT_TRUE(fitter.pass(found, true, pass));
  }

  RecordedPlant files{nearly_empty_tanks()};
  SiteModel model{files.diagram(), {files.experiment()}, {}};
  SiteFilter filter{model};
  SiteFitter fitter{filter, model.record().rows(), [] { return false; }};
  SiteHypothesis found;
  SitePass pass;
};

TEST_F(ShortenedCorrection, OccursInTheseTanks) {
  EXPECT_GT(std::ranges::count_if(pass.share, [](double share) { return share < 1; }), 5);
}

TEST_F(ShortenedCorrection, IsTakenAgainWhereGainsAreFrozen) {
  std::vector<double> error(pass.error.size());
  ASSERT_TRUE(filter.run_frozen(pass, error));
  for (size_t i = 0; i < error.size(); ++i) {
    if (std::isnan(pass.error[i])) continue;
    ASSERT_NEAR(error[i], pass.error[i], 1e-9 * std::sqrt(pass.variance[i])) << "reading " << i;
  }
}

TEST_F(ShortenedCorrection, IsKnownToTheObjectiveOfAnotherNoise) {
  EXPECT_NEAR(filter.objective_with(pass, pass.noise), pass.objective(), 1e-6 * std::abs(pass.objective()));
}

/// Differences against errors of another correction were divided by a step of 1e-5, and held every parameter
/// where it began.
TEST_F(ShortenedCorrection, LeavesParametersFree) {
  SiteHypothesis one = found;
  one.is_free.assign(one.is_free.size(), false), one.is_free[0] = true, one.factors[0] = 1.2;
  fitter.refine(one, 8);
  EXPECT_NEAR(one.factors[0], 1, 0.01);
}

}  // namespace
}  // namespace loopwright::shortened_correction_test
