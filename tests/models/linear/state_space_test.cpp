#include "models/linear/state_space.h"
#include <gtest/gtest.h>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

namespace loopwright::state_space_test {
namespace {

using Eigen::MatrixXd;

StateSpace lag(double pole) {
  StateSpace system;
  system.A = MatrixXd::Constant(1, 1, -pole), system.B = MatrixXd::Constant(1, 1, pole);
  system.C = MatrixXd::Ones(1, 1), system.D = MatrixXd::Zero(1, 1);
  return system;
}

std::complex<double> response(const StateSpace& s, std::complex<double> p) {
  const Eigen::MatrixXcd pencil = p * MatrixXd::Identity(s.states(), s.states()) - s.A;
  return (s.C * pencil.inverse() * s.B + s.D)(0, 0);
}

TEST(StateSpace, AHoldBeforeALagIsTheKnownRecursion) {
  const StateSpace sampled = hold_discretization(lag(30), 0.01);
  EXPECT_NEAR(sampled.A(0, 0), std::exp(-0.3), 1e-15);
  EXPECT_NEAR(sampled.B(0, 0), 1 - std::exp(-0.3), 1e-15);
  EXPECT_EQ(sampled.sample_time, 0.01);
}

TEST(StateSpace, AHoldBeforeADoubleIntegratorIsExactThoughItsMatrixIsSingular) {
  StateSpace mass;
  mass.A.resize(2, 2), mass.B.resize(2, 1);
  mass.A << 0, 1, 0, 0;
  mass.B << 0, 4;
  mass.C = MatrixXd::Identity(2, 2), mass.D = MatrixXd::Zero(2, 1);
  const StateSpace sampled = hold_discretization(mass, 0.5);
  EXPECT_EQ(sampled.A(0, 1), 0.5);
  EXPECT_EQ(sampled.B(0, 0), 0.5);
  EXPECT_EQ(sampled.B(1, 0), 2);
}

TEST(StateSpace, PartsThatDoNotActOnEachOtherStayApartWhenHeld) {
  StateSpace s;
  s.A = MatrixXd::Zero(3, 3), s.B = MatrixXd::Zero(3, 1), s.C = MatrixXd::Ones(1, 3),
  s.D = MatrixXd::Zero(1, 1);
  s.A << -3e4, 0, 0, 7, -2, 1e-3, 0, 5, -900;
  s.B << 1e5, 0, 0;
  const StateSpace held = hold_discretization(s, 0.37);
  EXPECT_EQ(held.A(0, 1), 0);
  EXPECT_EQ(held.A(0, 2), 0);
  EXPECT_NE(held.A(2, 0), 0);
}

TEST(StateSpace, SystemsInSeriesAndInParallelRespondAsTheirProductAndSum) {
  const std::complex<double> p(0.3, 7);
  const StateSpace a = lag(2), b = lag(5);
  EXPECT_NEAR(std::abs(response(in_series(a, b), p) - response(a, p) * response(b, p)), 0, 1e-15);
  EXPECT_NEAR(std::abs(response(in_parallel(a, b, -1), p) - (response(a, p) - response(b, p))), 0, 1e-15);
}

TEST(StateSpace, AnApproximateDelayHasGainOneAndThePhaseOfTheDelay) {
  StateSpace delay;
  delay.A.resize(0, 0), delay.B.resize(0, 2), delay.C.resize(2, 0);
  delay.D.resize(2, 2), delay.D << 0, 1, 1, 0;
  delay.delays = {0.02};
  const StateSpace rational = with_approximate_delays(delay, 6);
  EXPECT_EQ(rational.states(), 6);
  for (double turn : {0.1, 1.0, 3.0, 5.0}) {
    const std::complex<double> p(0, turn / 0.02);
    EXPECT_NEAR(std::abs(response(rational, p) - std::exp(-p * 0.02)), 0, 1e-2) << turn;
  }
  EXPECT_NEAR(std::abs(response(rational, {0, 50}) - std::exp(std::complex<double>(0, -1))), 0, 1e-10);
  EXPECT_THROW(hold_discretization(delay, 0.01), std::invalid_argument);
}

}  // namespace
}  // namespace loopwright::state_space_test
