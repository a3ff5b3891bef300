#include "models/gp/table.h"
#include <gtest/gtest.h>
#include "tests/models/gp/disturbance.h"

namespace loopwright::gp::table_test {
namespace {

Model model_of(const Kernel& kernel, Velocities velocities, bool structured = true) {
  const Samples samples = disturbance(250, velocities);
  Model model{kernel, 0.12, 0, 0, {Range{0.1, 0.325}, Range{0.05, 0.5}}, samples};
  std::string why_not;
  if (structured) model.data = *summarise(kernel, {kernel.terms[0].along[0].length, 0.1}, samples, why_not);
  return model;
}

/// The largest difference between table and posterior, also far outside the samples.
double greatest_error(const Posterior& posterior, const MeanTable& table, int points) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> x(-0.2, 0.9), v(-3, 3), near(0.05, 0.5);
  double greatest = 0;
  for (int i = 0; i < points; ++i) {
    const Point at{x(random), i % 2 ? v(random) : near(random)};
    greatest = std::max(greatest, std::abs(table(at) - posterior.mean(at)));
  }
  return greatest;
}

TEST(MeanTable, StaysWithinItsBoundEverywhere) {
  for (const Kernel& kernel : {additive(), double_smooth(), product(), smooth_product_and_constant()})
    for (double tolerance : {1e-3, 1e-6}) {
      const Posterior posterior(model_of(kernel, Velocities::few));
      const MeanTable table(posterior, tolerance);
      EXPECT_LE(table.bound(), tolerance * 1.01);
      const double error = greatest_error(posterior, table, 4000);
      EXPECT_LE(error, table.bound());
      EXPECT_GT(error, 1e-3 * table.bound()) << "the bound says nothing";
    }
}

TEST(MeanTable, ServesModelsWithoutStructureToo) {
  Kernel kernel = additive();
  kernel.terms.push_back(Term{0.1, {smooth(0.05), Shape{}}});
  const Posterior posterior(model_of(kernel, Velocities::continuous, false));
  const MeanTable table(posterior);
  EXPECT_LE(greatest_error(posterior, table, 2000), table.bound());
}

TEST(MeanTable, BoundIsGivenHonestlyWhereTheToleranceIsOutOfReach) {
  const Posterior posterior(model_of(product(), Velocities::few));
  const MeanTable table(posterior, 1e-15);
  EXPECT_GT(table.bound(), 1e-15);
  EXPECT_LE(greatest_error(posterior, table, 1000), table.bound());
}

TEST(SlopeBounds, AreNeverExceededAndNotFarAway) {
  for (const Kernel& kernel : {additive(), product()}) {
    const Posterior posterior(model_of(kernel, Velocities::few));
    const SlopeBounds bounds = slope_bounds(posterior);
    double by_x = 0, by_v = 0, mean = 0;
    for (double v = 0.05; v <= 0.5; v += 0.01)
      for (double x = 0; x < pitch; x += pitch / 200) {
        const double hx = 1e-7, hv = 1e-6;
        by_x = std::max(by_x, std::abs(posterior.mean({x + hx, v}) - posterior.mean({x - hx, v})) / (2 * hx));
        by_v = std::max(by_v, std::abs(posterior.mean({x, v + hv}) - posterior.mean({x, v - hv})) / (2 * hv));
        mean = std::max(mean, std::abs(posterior.mean({x, v})));
      }
    EXPECT_GE(bounds.by_position, by_x * (1 - 1e-6));
    EXPECT_LE(bounds.by_position, 1.6 * by_x);
    EXPECT_GE(bounds.by_velocity, by_v * (1 - 1e-6));
    EXPECT_LE(bounds.by_velocity, 3 * by_v);
    EXPECT_GE(bounds.mean, mean);
    EXPECT_LE(bounds.mean, 1.6 * mean);
  }
}

}  // namespace
}  // namespace loopwright::gp::table_test
