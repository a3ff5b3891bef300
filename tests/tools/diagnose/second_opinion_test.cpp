// Where a state is not measured, noise in it could explain anything: answers by simulation.
#include <gmock/gmock.h>
#include <cmath>
#include "tests/judgement.h"
#include "tests/tools/diagnose/diagnosed_plant.h"
#include "tools/diagnose/predict/site_filter.h"
#include "tools/diagnose/search/site_simulation.h"
#include "where.h"

namespace loopwright::second_opinion_test {
namespace {

using testing::Contains, testing::HasSubstr, testing::IsEmpty;

/// Two tanks of which only the lower level is measured.
Plant lower_tank_only(const Tanks& m, uint64_t seed) {
  Plant plant = tanks(m, seed);
  plant.compare = R"("level2.y": {"column": "y0", "unit": "m"})";
  plant.outputs = [](const Numbers& x) { return Numbers{x[1]}; };
  plant.measurement_noise = {1e-3}, plant.rows = 1600;
  return plant;
}

/// Predictions of one sample blame it on noise in the upper tank, and name something else.
TEST(SecondOpinion, AnOverflowOfATankThatIsNotMeasuredIsNamedAtIt) {
  Tanks m;
  m.spilled = [](double level, double) { return 0.05 * std::max(0.0, level - 0.45); };
  const Diagnosis d = diagnosed(lower_tank_only(m, 4));
  EXPECT_THAT(terms(d), testing::ElementsAre("outlet1.y: overflow(level1.y)")) << to_text(d);
  ASSERT_EQ(d.effects.size(), 1u);
  expect_parameter(d.effects[0], "slope", 0.05, 0.01, "m^2/s");
  expect_parameter(d.effects[0], "level", 0.45, 0.01, "m");
}
TEST(SecondOpinion, NoiseOfAStateThatIsNotMeasuredIsNoEffect) {
  Plant plant = lower_tank_only({}, 5);
  plant.process_noise = {1e-3, 2e-5};  // of some 2e-3 that flow
  const Diagnosis d = diagnosed(plant);
  EXPECT_THAT(terms(d), IsEmpty()) << to_text(d);
  EXPECT_THAT(d.moved_parameters, IsEmpty());
  EXPECT_THAT(findings(d), Contains(HasSubstr("(not measured: level1.y)"))) << to_text(d);
}

/// A spring that pushes in the place of one that pulls: corrected at every row, the model follows the record,
/// and no simulation does.
TEST(SecondOpinion, KnowsMotionThatForgetsItsStart) {
  for (const bool pushes : {false, true}) {
    Plant plant = oscillator({}, 7);
    if (pushes) plant.diagram.replace(plant.diagram.find(R"("+--")"), 5, R"("+-+")");
    const RecordedPlant files(plant);
    diagnosis::SiteModel model(files.diagram(), {files.experiment()}, {});
    diagnosis::SiteFilter filter(model);
    diagnosis::SiteFitter fitter(filter, model.record().held_out_from, [] { return false; });
    diagnosis::SiteHypothesis h;
    h.factors.assign(model.parameters().size(), 1.0), h.is_free.assign(h.factors.size(), false);
    h.noise = filter.guess_noise();
    EXPECT_EQ(diagnosis::forgets_its_start(fitter, h), pushes);
  }
}

TEST(SecondOpinion, ASimulationBeginsWithTheStatesThatFitBest) {
  Plant plant = lower_tank_only({}, 6);
  plant.initial = {0.6, 0.3}, plant.process_noise = {0, 0};
  const RecordedPlant files(plant);
  diagnosis::SiteModel model(files.diagram(), {files.experiment()}, {});
  diagnosis::SiteFilter filter(model);
  model.use(std::vector<double>(model.parameters().size(), 1.0), {});
  std::vector<double> e(model.record().rows());
  ASSERT_TRUE(filter.simulate_freely(0, e.size(), e));
  double square = 0;
  for (double x : e) square += x * x;
  EXPECT_NEAR(std::sqrt(square / double(e.size())), 1e-3, 5e-5) << "the noise of the sensor";
}

TEST(MeasuredTanks, OverflowOfTheUpperTankIsNamedAtIt) {
  IS_A_JUDGEMENT();
  setenv("LOOPWRIGHT_DATA", LOOPWRIGHT_SOURCE "/../shared/data", 0);
  if (!std::filesystem::exists(std::string(std::getenv("LOOPWRIGHT_DATA")) + "/cascaded_tanks/tanks_est.csv"))
    GTEST_SKIP() << "no cascaded_tanks/tanks_est.csv below $LOOPWRIGHT_DATA";
  const std::string folder = LOOPWRIGHT_SOURCE "/diagrams/tanks/";
  const Diagnosis d = diagnose(folder + "nominal.json", {folder + "estimation.experiment.json",
                                                         folder + "validation.experiment.json"});
  if (getenv("SHOW_DIAGNOSES"))
    for (const std::string& line : d.trail) puts(line.c_str());
  EXPECT_THAT(terms(d), Contains("out1.y: overflow(upper.y)")) << to_text(d);
  EXPECT_LE(d.steps.back().simulation_rmse, 0.0045) << "m, which stand for 0.45 V; held out";
  EXPECT_EQ(d.verdict, Verdict::partly_explained);
  EXPECT_THAT(findings(d), Contains(HasSubstr("(not measured: upper.y)"))) << to_text(d);
}

}  // namespace
}  // namespace loopwright::second_opinion_test
