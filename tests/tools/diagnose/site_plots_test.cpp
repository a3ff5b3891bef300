// What the page of a diagnosis without roles draws.
#include <gmock/gmock.h>
#include <cmath>
#include "tests/tools/diagnose/diagnosed_plant.h"

namespace loopwright::site_plots_test {
namespace {

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
