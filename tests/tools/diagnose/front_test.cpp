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

Plant oscillator_of_few_samples() {
  const Oscillator m;
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

/// [largest position] The largest error of a sample, but where friction holds the mass.
double error_of_flow(const TermShape& shape) {
  const Plant plant = oscillator_of_few_samples();
  const RecordedPlant files(plant);
  SiteModel model(files.diagram(), {files.experiment()}, {});
  const auto place = [](const auto& list, const char* name, auto member) {
    return int(std::ranges::find(list, name, member) - list.begin());
  };
  SiteTerm term;
  term.shape = &shape;
  term.site = place(model.sites(), "net.sum", &Site::name);
  term.variable = place(model.variables(), "mass.velocity", &SiteVariable::name);
  term.coefficient[0] = -level, term.nonlinear[0] = width;
  model.set_substeps(4);
  model.use(std::vector<double>(model.parameters().size(), 1.0), std::array{term});
  std::vector<double> state = model.initial_states(0), next(2);
  double off = 0, largest = 0;
  for (size_t row = 0; row < 200; ++row) {
    const Motion truth =
        integrated({state[0], state[1]}, model.record().inputs[0].value[row], plant.sample_time);
    EXPECT_TRUE(model.flow(row, state.data(), next.data()));
    largest = std::max(largest, std::abs(next[0]));
    if (std::max(std::abs(state[1]), std::abs(next[1])) > 50 * width)
      off = std::max(off, std::abs(next[0] - truth.position));
    state = next;
  }
  return off / largest;
}

TEST(Front, DryFrictionAtEightSamplesAPeriodIsFollowed) {
  const TermShape& sign = *std::ranges::find(named_shapes(), "sign", &TermShape::name);
  TermShape jumped_over = sign;
  jumped_over.has_front = false;
  const double off = error_of_flow(sign);
  EXPECT_LT(off, 2e-5);
  EXPECT_GT(error_of_flow(jumped_over), 20 * off);
}

}  // namespace
}  // namespace loopwright::diagnosis::front_test
