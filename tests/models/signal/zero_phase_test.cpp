#include "models/signal/zero_phase.h"
#include <gtest/gtest.h>

namespace loopwright::zero_phase_test {
namespace {

constexpr double step = 1e-3, cutoff = 2 * std::numbers::pi * 20;  // s, rad/s

/// In-phase and quadrature amplitude of a filtered sine of angular frequency w, away from the ends.
std::pair<double, double> response(double w) {
  std::vector<double> x;
  for (int k = 0; k < 6000; ++k) x.push_back(std::sin(w * step * k));
  const std::vector<double> y = zero_phase_low_pass(x, cutoff, step);
  double in = 0, across = 0, squares = 0;
  for (int k = 1000; k < 5000; ++k) {
    in += y[size_t(k)] * std::sin(w * step * k), across += y[size_t(k)] * std::cos(w * step * k);
    squares += std::pow(std::sin(w * step * k), 2);
  }
  return {in / squares, across / squares};
}

TEST(ZeroPhaseLowPass, HasTheGainOfAButterworthFilterSquaredAndNoPhase) {
  for (double hertz : {2.0, 10.0, 20.0, 40.0}) {
    const double w = 2 * std::numbers::pi * hertz;
    const double warped =
        std::tan(0.5 * w * step) / std::tan(0.5 * cutoff * step);  // of the bilinear transform
    const auto [in, across] = response(w);
    EXPECT_NEAR(in, 1 / (1 + std::pow(warped, 4)), 2e-3) << hertz;
    EXPECT_NEAR(across, 0, 2e-3) << hertz;
  }
}

TEST(ZeroPhaseLowPass, KeepsAConstantAndAnEmptySignal) {
  for (double y : zero_phase_low_pass(std::vector<double>(50, 0.7), cutoff, step)) EXPECT_NEAR(y, 0.7, 1e-12);
  EXPECT_TRUE(zero_phase_low_pass({}, cutoff, step).empty());
}

TEST(CentralDifference, IsExactForAParabolaInside) {
  std::vector<double> x;
  for (int k = 0; k < 20; ++k) x.push_back(3 * std::pow(step * k, 2));
  const std::vector<double> slope = central_difference(x, step);
  for (size_t k = 1; k + 1 < slope.size(); ++k) EXPECT_NEAR(slope[k], 6 * step * double(k), 1e-12);
}

}  // namespace
}  // namespace loopwright::zero_phase_test
