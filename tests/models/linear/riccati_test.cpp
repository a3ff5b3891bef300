#include "models/linear/riccati.h"
#include <gtest/gtest.h>
#include <cmath>

namespace loopwright::riccati_test {
namespace {

using Eigen::MatrixXd;

StateSpace system_of(const MatrixXd& A, const MatrixXd& B, double sample_time = 0) {
  return {A, B, MatrixXd::Zero(0, A.rows()), MatrixXd::Zero(0, B.cols()), sample_time, {}};
}

/// Weight q on the first state, r on each input.
QuadraticCost cost_of(const StateSpace& s, double q, double r) {
  QuadraticCost cost{MatrixXd::Zero(s.states(), s.states()), r * MatrixXd::Identity(s.inputs(), s.inputs()),
                     MatrixXd::Zero(s.states(), s.inputs())};
  cost.Q(0, 0) = q;
  return cost;
}

StateSpace double_integrator() {
  MatrixXd A(2, 2), B(2, 1);
  A << 0, 1, 0, 0;
  B << 0, 1;
  return system_of(A, B);
}

TEST(Riccati, ADoubleIntegratorHasItsClosedForm) {
  // K = [√(q/r), √2 (q/r)^¼]: damping 1/√2 for all weights.
  for (double q : {1e-6, 1.0, 1e10}) {
    const StateSpace s = double_integrator();
    const Regulator found = regulator(s, cost_of(s, q, 2.0));
    const double stiffness = std::sqrt(q / 2);
    EXPECT_NEAR(found.K(0, 0) / stiffness, 1, 1e-12) << q;
    EXPECT_NEAR(found.K(0, 1) / std::sqrt(2 * stiffness), 1, 1e-12) << q;
    ASSERT_EQ(found.poles.size(), 2u);
    EXPECT_NEAR(found.poles[0].damping, std::sqrt(0.5), 1e-10);
    EXPECT_LT(found.residual, 1e-13);
  }
}

TEST(Riccati, AnUnstableSampledStateIsMirroredWhenEffortCountsAlone) {
  // x[k+1] = a x + b u with no weight on x: the least effort that stabilizes moves the pole from a to 1/a.
  const double a = 1.25, b = 0.3;
  const StateSpace s = system_of(MatrixXd::Constant(1, 1, a), MatrixXd::Constant(1, 1, b), 0.1);
  const Regulator found = regulator(s, cost_of(s, 1e-30, 1));
  ASSERT_EQ(found.poles.size(), 1u);
  EXPECT_NEAR(found.poles[0].value.real(), 1 / a, 1e-10);
}

TEST(Riccati, ASampledScalarSolvesItsQuadraticEquation) {
  // X = q + a² X r / (r + b² X)
  const double a = 0.9, b = 0.4, q = 3, r = 0.7;
  const StateSpace s = system_of(MatrixXd::Constant(1, 1, a), MatrixXd::Constant(1, 1, b), 1);
  const double X = regulator(s, cost_of(s, q, r)).X(0, 0);
  const double p = r * (1 - a * a) - b * b * q,
               exact = (-p + std::sqrt(p * p + 4 * b * b * q * r)) / (2 * b * b);
  EXPECT_NEAR(X, exact, 1e-13 * exact);
}

TEST(Riccati, StatesOfVeryDifferentSizeDoNotCostAccuracy) {
  // A mass of 1 kg at 10 kHz, position to a nanometre: q = 1e18.
  const StateSpace s = hold_discretization(double_integrator(), 1e-4);
  const Regulator found = regulator(s, cost_of(s, 1e18, 1e-2));
  EXPECT_EQ(found.poles.size(), 2u);
  EXPECT_LT(found.residual, 1e-12);
}

TEST(Riccati, ObstaclesAreFound) {
  MatrixXd A = MatrixXd::Zero(3, 3), B = MatrixXd::Zero(3, 1);
  A(0, 1) = 1, A(2, 2) = 0.5, B(1, 0) = 1;  // a double integrator, and an unstable mode of its own
  StateSpace s = system_of(A, B);
  auto found = obstacles(s, cost_of(s, 1, 1));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, Obstacle::Kind::uncontrollable);
  EXPECT_NEAR(found[0].mode.value.real(), 0.5, 1e-12);
  EXPECT_NEAR(found[0].mode.participation[2], 1, 1e-12);
  EXPECT_TRUE(regulator(s, cost_of(s, 1, 1)).poles.empty());
  s.A(2, 2) = -0.5;
  EXPECT_TRUE(obstacles(s, cost_of(s, 1, 1)).empty()) << "it decays by itself";
  QuadraticCost only_last = cost_of(s, 0, 1);
  only_last.Q(2, 2) = 1;
  found = obstacles(s, only_last);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].kind, Obstacle::Kind::free) << "the double integrator has no weight";
}

TEST(Riccati, AnUnstableModeWithoutWeightIsStabilizedAllTheSame) {
  MatrixXd A(2, 2), B(2, 1);
  A << 1, 0, 0, -1;
  B << 1, 1;
  const StateSpace s = system_of(A, B);
  QuadraticCost cost = cost_of(s, 0, 1);
  cost.Q(1, 1) = 1e-12;
  EXPECT_TRUE(obstacles(s, cost).empty());
  const Regulator found = regulator(s, cost);
  ASSERT_EQ(found.poles.size(), 2u);
  for (const Pole& pole : found.poles) EXPECT_NEAR(pole.value.real(), -1, 1e-5);
}

TEST(Riccati, AFilterOfARandomWalkHasItsClosedForm) {
  // x[k+1] = x + w, y = x + v: P² - q P - q r = 0
  const double q = 0.3, r = 2;
  StateSpace s = system_of(MatrixXd::Ones(1, 1), MatrixXd::Zero(1, 0), 1);
  s.C = MatrixXd::Ones(1, 1), s.D = MatrixXd::Zero(1, 0);
  const QuadraticCost noise{MatrixXd::Constant(1, 1, q), MatrixXd::Constant(1, 1, r), MatrixXd::Zero(1, 1)};
  const Filter found = filter(s, noise);
  const double P = 0.5 * (q + std::sqrt(q * q + 4 * q * r));
  EXPECT_NEAR(found.P(0, 0), P, 1e-13);
  EXPECT_NEAR(found.gain(0, 0), P / (P + r), 1e-13);
  EXPECT_NEAR(found.predictor(0, 0), P / (P + r), 1e-13);
}

}  // namespace
}  // namespace loopwright::riccati_test
