// What a sample makes of small changes, against differences of whole samples.
#include "tests/tools/diagnose/plants.h"
#include "tools/diagnose/predict/site_model.h"

namespace loopwright::diagnosis::flow_slopes_test {
namespace {

constexpr double change = 1e-4;

struct Slopes {
  FlowSlopes of;
  std::vector<double> from, to;
};

/// `sizes` of the states, by which they are changed in proportion.
Slopes slopes_at(SiteModel& model, size_t row, const std::vector<int>& sites,
                 const std::vector<double>& sizes) {
  Slopes s;
  s.from = model.initial_states(row), s.to.resize(s.from.size());
  for (size_t i = 0; i < s.from.size(); ++i) s.from[i] += 0.3 + 0.1 * double(i);  // not at rest
  std::vector<double> changes;
  for (double size : sizes) changes.push_back(change * size);
  s.of.prepare(changes, sites, std::vector(sites.size(), change), true);
  EXPECT_TRUE(model.flow(row, s.from.data(), s.to.data(), nullptr, &s.of));
  EXPECT_TRUE(s.of.is_known());
  return s;
}
/// Of the last states, by a change that `changed` makes and takes back.
std::vector<double> difference(SiteModel& model, size_t row, std::vector<double> from,
                               const std::vector<double>& to) {
  std::vector<double> changed(from.size());
  EXPECT_TRUE(model.flow(row, from.data(), changed.data()));
  for (size_t i = 0; i < changed.size(); ++i) changed[i] = (changed[i] - to[i]) / change;
  return changed;
}
template <class Column>
void expect_alike(const Column& column, const std::vector<double>& expected, double tolerance) {
  double size = 0;
  for (double x : expected) size = std::max(size, std::abs(x));
  for (size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(column[Eigen::Index(i)], expected[i], tolerance * size);
}
void expect_derivatives(SiteModel& model, const std::vector<double>& sizes, double tolerance) {
  constexpr size_t row = 7;
  std::vector<int> sites;
  for (int s = 0; s < int(model.sites().size()); ++s)
    if (model.output_of_sensor(s) < 0) sites.push_back(s);
  const Slopes s = slopes_at(model, row, sites, sizes);
  for (size_t i = 0; i < s.from.size(); ++i) {
    std::vector<double> moved = s.from;
    moved[i] += change;
    expect_alike(s.of.by_states().col(Eigen::Index(i)), difference(model, row, moved, s.to), tolerance);
  }
  for (size_t k = 0; k < sites.size(); ++k) {
    SCOPED_TRACE(model.sites()[size_t(sites[k])].name);
    model.hold(sites[k], change);
    expect_alike(s.of.by_held(k), difference(model, row, s.from, s.to), tolerance);
    model.hold(sites[k], 0);
    model.set_ramp(sites[k], row, change);
    expect_alike(s.of.by_ramp(k), difference(model, row, s.from, s.to), tolerance);
    model.set_ramp(sites[k], row, 0);
  }
}

TEST(FlowSlopes, OfALinearPlantAreItsDerivatives) {
  const RecordedPlant files(motor({}, 1));
  SiteModel model(files.diagram(), {files.experiment()}, {});
  for (int substeps : {1, 3}) {
    model.set_substeps(substeps);
    expect_derivatives(model, {3, 10, 100}, 1e-6);  // A, rad, rad/s
  }
}
// The curvature of a square root within a sample is left out.
TEST(FlowSlopes, OfTanksAreNearlyTheirDerivatives) {
  const RecordedPlant files(tanks({}, 1));
  SiteModel model(files.diagram(), {files.experiment()}, {});
  expect_derivatives(model, {1, 1}, 2e-3);
}
// A friction that is steep in the middle of a step is not as steep along it.
TEST(FlowSlopes, OfAStepBeyondWhatTheMethodIsStableToAreNotKnown) {
  for (const double rate : {-1000.0, -4000.0}) {  // [1/s]
    FlowSlopes slopes;
    slopes.prepare(std::vector{1e-6}, {}, {}, false);
    slopes.begin();
    slopes.by_state(0)[0] = rate;
    slopes.add_step(1e-3, 0, 1);
    EXPECT_EQ(slopes.is_known(), rate == -1000.0);
  }
}

}  // namespace
}  // namespace loopwright::diagnosis::flow_slopes_test
