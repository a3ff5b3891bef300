// What the page of a diagnosis without roles draws.
#include <gmock/gmock.h>
#include <cmath>
#include "tests/tools/diagnose/diagnosed_plant.h"
#include "tools/diagnose/search/site_start.h"
#include "tools/diagnose/verdict/site_plots.h"

namespace loopwright::site_plots_test {
namespace {

using namespace diagnosis;
using testing::Contains, testing::Field;

double friction(double speed) { return 0.01 * std::tanh(speed / 0.5); }

const Diagnosis& answer() {
  static const Diagnosis found = [] {
    Motor m;
    m.torque = [](double speed, double) { return friction(speed); };
    Plant plant = motor(m, 31);
    plant.rows = 1200;
    return diagnosed(plant);
  }();
  return found;
}

/// The points come from the errors along the record: where the speed is known, they lie on the true law.
TEST(SitePlots, PointsLieOnTheTrueLawAndTheShapeGoesThroughThem) {
  ASSERT_EQ(answer().terms.size(), 1u) << to_text(answer());
  const MissingTerm& term = answer().terms.front();
  EXPECT_EQ(term.site, "torques.sum");
  EXPECT_EQ(term.variable, "rotor.velocity");
  EXPECT_EQ(term.site_unit, "N*m");
  ASSERT_GT(term.at.size(), 10u);
  const double distance = term.at[1] - term.at[0];
  double square = 0, count = 0;
  for (size_t i = 0; i < term.at.size(); ++i) {
    if (std::abs(term.at[i]) < 2 * distance) continue;  // a straight line smears the step there
    square += std::pow(term.found[i] + friction(term.at[i]), 2), ++count;
  }
  EXPECT_LT(std::sqrt(square / count), 0.1 * 0.01);
  for (size_t i = 0; i < term.shape_at.size(); ++i)
    EXPECT_NEAR(term.shape[i], -friction(term.shape_at[i]), 0.2 * 0.01) << term.shape_at[i];
}

/// Of the output that is least white, at the distances of its own readings.
TEST(SitePlots, WhitenessIsThatOfOneOutputAndItsReadings) {
  Plant plant = thermal({}, 3);
  plant.reads_every = {1, 5};
  const Diagnosis d = diagnosed(plant);
  ASSERT_FALSE(d.whiteness.lag_s.empty());
  const bool is_slower = d.whiteness.port == "body2.y";
  EXPECT_TRUE(is_slower || d.whiteness.port == "body1.y") << d.whiteness.port;
  EXPECT_NEAR(d.whiteness.lag_s.front(), plant.sample_time * (is_slower ? 5 : 1), 0.05 * plant.sample_time);
  const double readings = 0.75 * double(plant.rows) / (is_slower ? 5 : 1);
  EXPECT_NEAR(d.whiteness.most, 1.96 / std::sqrt(readings), 0.2 / std::sqrt(readings));
}

/// Straight lines between nine nodes, which miss the true law a little: the points are nearer.
TEST(SitePlots, AFunctionWithoutANameIsDrawn) {
  const auto law = [](double x) { return 2 * std::sin(30 * x); };
  Oscillator m;
  m.force = [law](double x, double) { return law(x); };
  const RecordedPlant files(oscillator(m, 32));
  SiteModel model(files.diagram(), {files.experiment()}, {});
  SiteFilter filter(model);
  SiteFitter fitter(filter, model.record().held_out_from, [] { return false; });
  SiteHypothesis nominal;
  ASSERT_TRUE(start_from_stated(fitter, ErrorsOf::predictions, {}, nominal));
  SiteTerm term;
  term.shape = &unknown_functions()[0];
  term.site = int(std::ranges::find(model.sites(), "net.sum", &Site::name) - model.sites().begin());
  term.variable = int(std::ranges::find(model.variables(), "mass.position", &SiteVariable::name) -
                      model.variables().begin());
  const auto [low, high] = std::ranges::minmax(model.record().outputs[0].value);
  term.nonlinear = {low, high};
  for (int i = 0; i < term.shape->columns; ++i)
    term.coefficient[size_t(i)] = -law(low + (high - low) * i / (term.shape->columns - 1));
  SiteHypothesis found = nominal;
  found.terms = {term};
  fitter.fit_noise(found);
  Diagnosis result;
  add_site_plots(fitter, nominal, found, result);
  ASSERT_EQ(result.terms.size(), 1u);
  const MissingTerm& plot = result.terms.front();
  ASSERT_GT(plot.at.size(), 10u);
  double points = 0, line = 0;
  for (size_t i = 0; i < plot.at.size(); ++i) {
    points += std::pow(plot.found[i] + law(plot.at[i]), 2);
    line += std::pow(term.value(plot.at[i]) + law(plot.at[i]), 2);
  }
  EXPECT_LT(points, 0.25 * line);
}

TEST(SitePlots, ErrorsBecomeWhite) {
  const Diagnosis::Whiteness& w = answer().whiteness;
  ASSERT_EQ(w.lag_s.size(), 40u);
  EXPECT_DOUBLE_EQ(w.lag_s.front(), 1e-3);
  const auto outside = [&](const std::vector<double>& list) {
    return std::ranges::count_if(list, [&](double r) { return std::abs(r) > w.most; });
  };
  EXPECT_LE(outside(w.after), 6) << "a twentieth of forty, by chance";
  EXPECT_GT(outside(w.before), outside(w.after));
}

TEST(SitePlots, ThePictureMarksTheAddedBlock) {
  EXPECT_THAT(answer().picture.nodes, Contains(Field(&report::GraphNode::room, "added")));
}

}  // namespace
}  // namespace loopwright::site_plots_test
