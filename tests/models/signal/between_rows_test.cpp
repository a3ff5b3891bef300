#include "models/signal/between_rows.h"
#include <gtest/gtest.h>
#include <cmath>
#include <functional>
#include <numbers>

namespace loopwright::between_rows_test {
namespace {

using enum BetweenRows;

/// Mean and first moment by small steps: the line over [0, length].
MeanLine by_small_steps(const std::function<double(double)>& f, double length) {
  constexpr int steps = 20'000;
  MeanLine line;
  for (int i = 0; i < steps; ++i) {
    const double at = (i + 0.5) / steps, value = f(at * length);
    line.mean += value / steps, line.change += 12 * value * (at - 0.5) / steps;
  }
  return line;
}

const std::vector<double> uneven{0, 1, 1.4, 3, 3.9, 5.2, 6}, values{2, -1, 4, 3, 3.5, -2, 0};

TEST(CubicSpline, WithoutAKnotNearItsEndsReproducesACubic) {
  std::vector<double> y;
  for (double x : uneven) y.push_back(x * x * x - 4 * x * x + 2);
  const CubicSpline spline(uneven, y, SplineEnds::not_a_knot);
  for (double x = -0.5; x < 6.5; x += 0.01) {
    EXPECT_NEAR(spline.at(x).value, x * x * x - 4 * x * x + 2, 1e-11) << x;
    EXPECT_NEAR(spline.at(x).bend, 6 * x - 8, 1e-11) << x;
  }
  const CubicSpline of_three({0, 1, 2}, {0, 1, 0}, SplineEnds::not_a_knot);
  EXPECT_NEAR(of_three.at(0).bend, 0, 1e-14) << "too few points: natural ends";
}

TEST(CubicPiece, ItsLineHasItsMeanAndItsFirstMoment) {
  for (const BetweenRows between : {hold, linear, band_limited}) {
    const RowCurve curve(uneven, values, between);
    for (size_t row = 0; row < uneven.size(); ++row) {
      const CubicPiece whole = curve.piece(row);
      for (const CubicPiece& piece : {whole, whole.part(0.2 * whole.length, 0.7 * whole.length)}) {
        const MeanLine line = piece.line(),
                       expected = by_small_steps([&](double t) { return piece.at(t).value; }, piece.length);
        EXPECT_NEAR(line.mean, expected.mean, 1e-7) << row;
        EXPECT_NEAR(line.change, expected.change, 1e-7) << row;
      }
    }
  }
}

TEST(RowCurve, PassesThroughItsRows) {
  for (const BetweenRows between : {hold, linear, band_limited}) {
    const RowCurve curve(uneven, values, between);
    for (size_t row = 0; row < uneven.size(); ++row) EXPECT_EQ(curve.at(uneven[row]), values[row]) << row;
    EXPECT_EQ(curve.at(9), values.back()) << "held after the last row";
    EXPECT_EQ(RowCurve({1}, {7}, between).at(3), 7);
  }
  EXPECT_EQ(RowCurve(uneven, values, hold).at(2.9), 4);
  EXPECT_NEAR(RowCurve(uneven, values, linear).at(2.2), 3.5, 1e-15);
}

TEST(RowCurve, HasTheGainThatItsDescriptionStates) {
  const auto gain = [](double of_half_the_rate) {
    const double w = std::numbers::pi * of_half_the_rate;
    std::vector<double> time, value;
    for (int k = 0; k < 400; ++k) time.push_back(k), value.push_back(std::sin(w * k));
    const RowCurve curve(time, value, band_limited);
    double along = 0, square = 0;
    for (double t = 104; t < 296; t += 1.0 / 64)
      along += curve.at(t) * std::sin(w * t), square += std::sin(w * t) * std::sin(w * t);
    return along / square;
  };
  EXPECT_NEAR(gain(0.125), 1 - 3.4e-5, 1e-6);
  EXPECT_NEAR(gain(0.25), 1 - 6.1e-4, 1e-5);
  EXPECT_NEAR(gain(0.5), 1 - 1.45e-2, 1e-4);
}

/// The rows of a wave that begins at its crest.
double error_at_start(SplineEnds ends) {
  std::vector<double> time, value;
  for (int k = 0; k < 40; ++k) time.push_back(k), value.push_back(std::cos(std::numbers::pi / 4 * k));
  const CubicSpline spline(time, value, ends);
  double most = 0;
  for (double t = 0; t < 2; t += 0.01)
    most = std::max(most, std::abs(spline.at(t).value - std::cos(std::numbers::pi / 4 * t)));
  return most;
}
TEST(RowCurve, BeginsBetterThanWithNaturalEnds) {
  EXPECT_LT(error_at_start(SplineEnds::not_a_knot), 0.01);
  EXPECT_GT(error_at_start(SplineEnds::natural), 0.03);
}

}  // namespace
}  // namespace loopwright::between_rows_test
