// Steps of the integration end before a law changes its side, and go through that in parts.
#include "tools/diagnose/predict/front.h"
#include <gmock/gmock.h>
#include <algorithm>
#include <cmath>
#include "tests/tools/diagnose/plants.h"
#include "tools/diagnose/predict/site_model.h"

namespace loopwright::diagnosis::front_test {
namespace {

/// Of a step of 1 s from a signal with a slope, bent or not, through a front that is 0.01 wide.
double longest_step(double signal, double slope, double bend = 0) {
  Front front(0.01);
  front.begins(signal);
  front.goes(signal + slope * 0.5, 1);
  front.bends(signal + slope * 0.5 + bend * 0.25, 1);
  return front.longest_step();
}

TEST(Front, AStepEndsWhereItBegins) {
  EXPECT_NEAR(longest_step(1, -2), (1 - 0.04) / 2, 1e-12) << "four widths before zero";
  EXPECT_NEAR(longest_step(-1, 2), (1 - 0.04) / 2, 1e-12);
  EXPECT_NEAR(longest_step(1, 0, -2), std::sqrt((1 - 0.04) / 2), 1e-12) << "the signal bends";
}
TEST(Front, AStepGoesThroughAPartOfIt) {
  EXPECT_NEAR(longest_step(0.03, -2), 0.02 / 2, 1e-12) << "two widths";
  EXPECT_NEAR(longest_step(0, 2), 0.02 / 2, 1e-12);
}
TEST(Front, AStepThatIsShorterThanAPartOrLeadsAwayKeepsItsLength) {
  EXPECT_GT(longest_step(0.03, -0.001), 1);
  EXPECT_GT(longest_step(1, 2), 1);
  EXPECT_GT(longest_step(1, -2, 2), 1) << "it turns before zero";
}

constexpr double level = 3, width = 2e-3;

/// Dry friction at eight samples a period: 1.5 kg on 5.5 kN/m.
Plant oscillator_of_few_samples() {
  Oscillator m;
  m.mass = 0.5, m.damping = 1.5, m.stiffness = 200;
  Plant plant = oscillator(m, 5);
  plant.sample_time = 2 * std::numbers::pi / std::sqrt(m.stiffness / m.mass) / 8;
  plant.rows = 400;
  return plant;
}

struct Motion {
  double position = 0, velocity = 0;
};
/// By the midpoint rule in steps that pass the width of the friction in parts.
Motion integrated(Motion m, double force, double time) {
  constexpr int steps = 20000;
  const double h = time / steps;
  const auto rate = [&](double x, double v) {
    return (force - 1.5 * v - 200 * x - level * std::tanh(v / width)) / 0.5;
  };
  for (int i = 0; i < steps; ++i) {
    const double half = m.velocity + h / 2 * rate(m.position, m.velocity);
    const double middle = rate(m.position + h / 2 * m.velocity, half);
    m.position += h * half, m.velocity += h * middle;
  }
  return m;
}

TEST(Front, DryFrictionAtEightSamplesAPeriodIsFollowed) {
  const Plant plant = oscillator_of_few_samples();
  const RecordedPlant files(plant);
  SiteModel model(files.diagram(), {files.experiment()}, {});
  SiteTerm term;
  term.shape = &*std::ranges::find(named_shapes(), "sign", &TermShape::name);
  term.site = int(std::ranges::find(model.sites(), "net.sum", &Site::name) - model.sites().begin());
  term.variable = int(std::ranges::find(model.variables(), "mass.velocity", &SiteVariable::name) -
                      model.variables().begin());
  term.coefficient[0] = -level, term.nonlinear[0] = width;
  model.set_substeps(4);
  const std::vector<double> factors(model.parameters().size(), 1.0);
  model.use(factors, std::array{term});
  const std::vector<double> initial = model.initial_states(0);
  ASSERT_EQ(initial.size(), 2u);
  std::vector<double> state{initial}, next(2);
  double off = 0, largest = 0;
  for (size_t row = 0; row + 1 < 200; ++row) {
    const Motion truth =
        integrated({state[0], state[1]}, model.record().inputs[0].value[row], plant.sample_time);
    ASSERT_TRUE(model.flow(row, state.data(), next.data()));
    off = std::max(off, std::abs(next[0] - truth.position)), largest = std::max(largest, std::abs(next[0]));
    state = next;
  }
  EXPECT_GT(largest, 0.05);
  EXPECT_LT(off, 2e-4 * largest) << "in one sample; a hundred times that where steps jump over the front";
}

}  // namespace
}  // namespace loopwright::diagnosis::front_test
