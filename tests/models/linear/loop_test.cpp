#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include "models/linear/frequency_response.h"
#include "models/linear/margins.h"
#include "models/linear/norms.h"

namespace loopwright::loop_test {
namespace {

using Eigen::MatrixXd;
using std::numbers::pi;
using Complex = std::complex<double>;

/// gain / (s + pole)
StateSpace first_order(double gain, double pole) {
  return {MatrixXd::Constant(1, 1, -pole),
          MatrixXd::Ones(1, 1),
          MatrixXd::Constant(1, 1, gain),
          MatrixXd::Zero(1, 1),
          0,
          {}};
}

StateSpace with_delay(const StateSpace& s, double delay) {
  StateSpace result = s;
  result.B.resize(s.states(), 2), result.B << MatrixXd::Zero(s.states(), 1), s.B;
  result.C.resize(2, s.states()), result.C << s.C, MatrixXd::Zero(1, s.states());
  result.D.resize(2, 2), result.D << 0, s.D(0, 0), 1, 0;
  result.delays = {delay};
  return result;
}

TEST(FrequencyResponse, IsTheTransferFunctionOnTheAxis) {
  const StateSpace s = in_series(first_order(3, 2), first_order(5, 7));
  for (double w : {0.0, 0.1, 4.0, 300.0})
    EXPECT_NEAR(std::abs(FrequencyResponse(s).at(w)(0, 0) - 15.0 / (Complex(2, w) * Complex(7, w))), 0,
                1e-13);
}

TEST(FrequencyResponse, ADelayTurnsThePhaseExactly) {
  const StateSpace s = with_delay(first_order(3, 2), 0.25);
  for (double w : {0.1, 4.0, 300.0})
    EXPECT_NEAR(
        std::abs(FrequencyResponse(s).at(w)(0, 0) - 3.0 * std::exp(Complex(0, -0.25 * w)) / Complex(2, w)), 0,
        1e-13);
}

TEST(FrequencyResponse, OfASampledSystemIsOnTheUnitCircle) {
  const StateSpace s = hold_discretization(first_order(2, 2), 0.1);
  const double a = std::exp(-0.2);
  for (double w : {0.5, 10.0, pi / 0.1})
    EXPECT_NEAR(std::abs(FrequencyResponse(s).at(w)(0, 0) - (1 - a) / (std::exp(Complex(0, 0.1 * w)) - a)), 0,
                1e-13);
}

TEST(FrequencyResponse, ASystemLiftedWithoutNeedAnswersAsBefore) {
  const StateSpace s = hold_discretization(first_order(2, 2), 0.1);
  StateSpace lifted{s.A * s.A, MatrixXd(1, 2), MatrixXd(2, 1), MatrixXd(2, 2), 0.2, {}};
  lifted.B << s.A * s.B, s.B;
  lifted.C << s.C, s.C * s.A;
  lifted.D << s.D, MatrixXd::Zero(1, 1), s.C * s.B, s.D;
  for (double w : {0.5, 10.0, 25.0})
    EXPECT_NEAR(std::abs(FrequencyResponse(lifted, 2).at(w)(0, 0) - FrequencyResponse(s).at(w)(0, 0)), 0,
                1e-13);
}

TEST(Margins, OfAThirdOrderLagAreKnownOnPaper) {
  // 4/(s+1)³: phase -180° at √3, gain there 1/2, so the gain margin is 2.
  const StateSpace lag = first_order(1, 1);
  const StateSpace L = in_series(in_series(first_order(4, 1), lag), lag);
  const Margins m = margins(L);
  EXPECT_TRUE(m.is_stable());
  EXPECT_NEAR(m.gain, 2, 1e-9);
  EXPECT_NEAR(m.gain_frequency, std::sqrt(3.0), 1e-9);
  const double crossover = std::sqrt(std::pow(4, 2.0 / 3) - 1), phase = pi - 3 * std::atan(crossover);
  EXPECT_NEAR(m.phase, phase, 1e-9);
  EXPECT_NEAR(m.delay, phase / crossover, 1e-9);
}

TEST(Margins, TheDelayMarginIsTheDelayThatEndsStability) {
  const StateSpace L = in_series(first_order(20, 0), first_order(30, 30));
  const Margins m = margins(L);
  EXPECT_TRUE(margins(with_delay(L, 0.99 * m.delay)).is_stable());
  EXPECT_FALSE(margins(with_delay(L, 1.01 * m.delay)).is_stable());
}

TEST(Margins, MsIsTheInverseDistanceFromMinusOne) {
  // L = k/s with delay τ: at k τ = 0.5 the peak of 1/|1 + L| was determined separately on a fine grid.
  const StateSpace L = with_delay(first_order(5, 0), 0.1);
  double peak = 0;
  for (double w = 1; w < 60; w += 1e-3)
    peak = std::max(peak, 1 / std::abs(1.0 + 5.0 * std::exp(Complex(0, -0.1 * w)) / Complex(0, w)));
  EXPECT_NEAR(margins(L).Ms, peak, 1e-6);
}

TEST(Margins, AConditionallyStableLoopHasALowerGainMargin) {
  // L = 10 (s+1)²/s³: its phase, 2 atan ω - 270°, is -180° at ω = 1, where |L| = 20. A lower gain makes the
  // loop unstable.
  const StateSpace pi_part = {
      MatrixXd::Zero(1, 1), MatrixXd::Ones(1, 1), MatrixXd::Ones(1, 1), MatrixXd::Ones(1, 1), 0, {}};
  const Margins m = margins(in_series(in_series(pi_part, pi_part), first_order(10, 0)));
  EXPECT_TRUE(m.is_stable());
  EXPECT_NEAR(m.lower_gain, 1 / 20.0, 1e-9);
  EXPECT_NEAR(m.lower_gain_frequency, 1, 1e-9);
  EXPECT_EQ(m.gain, std::numeric_limits<double>::infinity());
}

TEST(Margins, ACrossoverFarAboveTheFastestPoleIsFound) {
  // L = 1e4/(s (s + 1)): |L| = 1 where ω² (ω² + 1) = 1e8. Ms from |1/(1 + L)|² = (x² + x)/((1e4 - x)² + x)
  // with x = ω², on a fine grid.
  const Margins m = margins(in_series(first_order(1e4, 0), first_order(1, 1)));
  const double crossover = std::sqrt((std::sqrt(1 + 4e8) - 1) / 2);
  EXPECT_TRUE(m.is_stable());
  EXPECT_NEAR(m.phase_frequency, crossover, 1e-6);
  EXPECT_NEAR(m.phase, pi / 2 - std::atan(crossover), 1e-9) << "0.57°";
  double peak = 0;
  for (double w = 95; w < 105; w += 1e-5)
    peak = std::max(peak, std::sqrt((std::pow(w, 4) + w * w) / (std::pow(1e4 - w * w, 2) + w * w)));
  EXPECT_NEAR(m.Ms, peak, 1e-6 * peak);
  EXPECT_NEAR(m.Ms_frequency, 100, 0.1);
}

TEST(Margins, OfAnIntegratorAreKnownAtEveryGain) {
  for (double gain : {1e-9, 5.0, 5000.0, 1e9}) {
    const Margins m = margins(first_order(gain, 0));
    EXPECT_NEAR(m.phase_frequency, gain, 1e-9 * gain);
    EXPECT_NEAR(m.phase, pi / 2, 1e-9);
    EXPECT_NEAR(m.delay, pi / 2 / gain, 1e-9 / gain);
  }
}

TEST(Margins, ACrossoverFarBelowTheFastestPoleIsFound) {
  // 5/((s + 1)(1e-7 s + 1)): beside 1e7 rad/s, 1 rad/s is nearly an integrator.
  const Margins m = margins(in_series(first_order(5, 1), first_order(1e7, 1e7)));
  const double crossover = std::sqrt(24.0);
  EXPECT_NEAR(m.phase_frequency, crossover, 1e-5);
  EXPECT_NEAR(m.phase, pi - std::atan(crossover) - std::atan(1e-7 * crossover), 1e-6);
}

TEST(Margins, OfASampledIntegratorAreKnownAtEveryGain) {
  // k/(z - 1) on z = e^(jωT): |L| = k/(2 sin(ωT/2)), its phase -90° - ωT/2.
  for (double gain : {1e-7, 0.1, 1.5}) {
    StateSpace L = first_order(gain, -1);  // A = 1
    L.sample_time = 1e-3;
    const Margins m = margins(L);
    const double half_turn = std::asin(gain / 2);
    EXPECT_NEAR(m.phase_frequency, 2 * half_turn / 1e-3, 1e-6 * gain / 1e-3);
    EXPECT_NEAR(m.phase, pi / 2 - half_turn, 1e-6);
    EXPECT_NEAR(m.gain, 2 / gain, 1e-6 / gain);
  }
}

TEST(Margins, AModeBehindTheLoopIsNamedAndNotJudged) {
  // A velocity loop 3/s; its integral is the position, and nothing reads it.
  StateSpace L = first_order(3, 0);
  L.A = MatrixXd::Zero(2, 2), L.A(1, 0) = 1;
  L.B = Eigen::Vector2d(1, 0), L.C = Eigen::RowVector2d(3, 0);
  for (double sample_time : {0.0, 0.01}) {
    const StateSpace loop = sample_time > 0 ? hold_discretization(L, sample_time) : L;
    const Margins m = margins(loop);
    EXPECT_TRUE(m.is_stable()) << sample_time;
    EXPECT_NEAR(m.largest_pole, sample_time > 0 ? 1 - 3 * 0.01 : -3, 1e-12);
    ASSERT_EQ(m.outside.size(), 1u);
    EXPECT_EQ(m.outside[0].stability, Stability::boundary);
    EXPECT_NEAR(m.outside[0].pole.participation[1], 1, 1e-12) << "the position";
  }
  L.A(1, 1) = 0.5;
  ASSERT_EQ(margins(L).outside.size(), 1u);
  EXPECT_EQ(margins(L).outside[0].stability, Stability::unstable) << "it grows, and that is not left out";
}

TEST(Margins, APositionOfWhichOnlyDifferencesAreReadIsOutside) {
  // v += u, p += v, and the controller reads p - (p before): z = 1 cancels. Around the rest, 0.2/(z (z - 1)):
  // z² - z + 0.2 = 0.
  StateSpace L;
  L.A.resize(3, 3), L.A << 1, 0, 0, 1, 1, 0, 0, 1, 0;  // v, p, p before
  L.B = Eigen::Vector3d(1, 0, 0), L.C = Eigen::RowVector3d(0, 0.2, -0.2);
  L.D = MatrixXd::Zero(1, 1), L.sample_time = 1;
  const Margins m = margins(L);
  EXPECT_TRUE(m.is_stable());
  EXPECT_NEAR(m.largest_pole, (1 + std::sqrt(0.2)) / 2, 1e-9);
  ASSERT_EQ(m.outside.size(), 1u);
  EXPECT_NEAR(std::abs(m.outside[0].pole.value - 1.0), 0, 1e-9);
}

TEST(Margins, AnUnstableModeThatCancelsInsideTheLoopIsUnstable) {
  // (s - 1)/(s + 2) in front of 1/(s - 1).
  StateSpace zero = first_order(-3, 2);
  zero.D(0, 0) = 1;
  EXPECT_EQ(margins(in_series(zero, first_order(1, -1))).stability, Stability::unstable);
}

TEST(Margins, ALoopOnTheBoundaryIsNotStable) {
  const Margins m = margins(first_order(-1, 1));  // 1 + L = s/(s + 1)
  EXPECT_EQ(m.stability, Stability::boundary);
  EXPECT_FALSE(m.is_stable());
  EXPECT_TRUE(m.outside.empty());
}

TEST(Norms, AnOscillatingResponseIsSummedInAbsoluteValue) {
  StateSpace s{MatrixXd::Constant(1, 1, -0.9),
               MatrixXd::Ones(1, 1),
               MatrixXd::Ones(1, 1),
               MatrixXd::Constant(1, 1, 2),
               1,
               {}};
  const Bounds sum = peak_to_peak_gain(s);
  EXPECT_LE(sum.lower, 12 + 1e-9);
  EXPECT_GE(sum.upper, 12 - 1e-9);
  EXPECT_LT(sum.upper - sum.lower, 1e-4);
}

TEST(Norms, TheIntegralOfAContinuousResponseComesFromFineSamples) {
  // 1/(s² + 2 ζ ω s + ω²): ∫|h| = coth(π ζ / (2 √(1-ζ²))) / ω².
  StateSpace s;
  s.A.resize(2, 2), s.A << 0, 1, -100, -2;
  s.B.resize(2, 1), s.B << 0, 1;
  s.C.resize(1, 2), s.C << 1, 0;
  s.D = MatrixXd::Zero(1, 1);
  const double wanted = 1 / std::tanh(pi * 0.1 / (2 * std::sqrt(1 - 0.01))) / 100;
  EXPECT_NEAR(peak_to_peak_gain(hold_discretization(s, 1e-3)).lower, wanted, 1e-4 * wanted);
}

TEST(Norms, TheEnergyGainIsTheResonancePeak) {
  StateSpace s;
  s.A.resize(2, 2), s.A << 0, 1, -100, -0.02;
  s.B.resize(2, 1), s.B << 0, 1;
  s.C.resize(1, 2), s.C << 1, 0;
  s.D = MatrixXd::Zero(1, 1);
  const double z = 1e-3, wanted = 1 / (2 * z * std::sqrt(1 - z * z)) / 100;
  const Bounds continuous = energy_gain(s);
  EXPECT_LE(continuous.lower, wanted * (1 + 1e-9));
  EXPECT_GE(continuous.upper, wanted * (1 - 1e-9));
  EXPECT_LT(continuous.upper / continuous.lower, 1.001);
}

TEST(Norms, OfASampledSystemTheyBoundItsResponseOnTheCircle) {
  const StateSpace s = hold_discretization(in_series(first_order(2, 2), first_order(5, 9)), 0.05);
  const Bounds energy = energy_gain(s);
  EXPECT_NEAR(energy.upper, 10.0 / 18, 1e-3);
  EXPECT_GE(energy.upper, std::abs(FrequencyResponse(s).at(0)(0, 0)));
  EXPECT_GE(peak_to_peak_gain(s).upper, energy.lower) << "peaks are never amplified less";
}

TEST(Norms, OfASystemThatForgetsSlowlyTheyAreSummedOrGivenUpAtOnce) {
  EXPECT_NEAR(peak_to_peak_gain(hold_discretization(first_order(1, 1e-4), 0.1)).upper, 1e4, 100);
  EXPECT_THROW(peak_to_peak_gain(hold_discretization(first_order(1, 1e-9), 0.1)), std::domain_error);
}

TEST(Norms, UnstableSystemsHaveNone) {
  EXPECT_THROW(energy_gain(first_order(1, -1)), std::domain_error);
  EXPECT_THROW(peak_to_peak_gain(hold_discretization(first_order(1, -1), 0.1)), std::domain_error);
}

}  // namespace
}  // namespace loopwright::loop_test
