#include "engine/solve/newton.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

#include "tests/engine/solve/allocations.h"

namespace loopwright::testing::newton_test {
namespace {

struct Equations {
  int unknowns;
  std::function<bool(const double* y, double* residual)> residual;
  AlgebraicSystem system() {
    return {this, unknowns, [](void* self, const double* y, double* residual_out) {
              return static_cast<Equations*>(self)->residual(y, residual_out);
            }};
  }
};

TEST(Newton, ALinearLoopTakesOneIteration) {
  // y0 = 1 - 0.5 y1, y1 = 2 y0
  Equations loop{2, [](const double* y, double* r) {
                   r[0] = y[0] - (1.0 - 0.5 * y[1]);
                   r[1] = y[1] - 2.0 * y[0];
                   return true;
                 }};
  NewtonSolver solver({}, loop.system());
  double y[] = {0.0, 0.0};
  const NewtonResult result = solver.solve(y);
  EXPECT_EQ(result.status, NewtonStatus::converged);
  EXPECT_LE(result.iterations, 2);
  EXPECT_NEAR(y[0], 0.5, 1e-10);
  EXPECT_NEAR(y[1], 1.0, 1e-10);
  EXPECT_LE(result.residual_norm, 1e-10);
}

TEST(Newton, SolutionsOfAnySizeAreFoundFromZero) {
  for (const double size : {1e-3, 1.0, 1e3, 1e6, 1e9}) {
    Equations cube{1, [size](const double* y, double* r) {
                     r[0] = y[0] - size + 1e-3 * size * std::tanh(y[0] / size);
                     return true;
                   }};
    NewtonSolver solver({}, cube.system());
    double y[] = {0.0};
    ASSERT_EQ(solver.solve(y).status, NewtonStatus::converged) << size;
    EXPECT_NEAR(y[0] / size - 1.0 + 1e-3 * std::tanh(y[0] / size), 0.0, 1e-9) << size;
  }
}

TEST(Newton, ADiodeInALoopIsSolvedFromFarAway) {
  // v = 5 V - R I(v), I = 1 pA (e^(v / 25 mV) - 1), R = 1 kΩ: the first Newton step reaches a point at which
  // the current is 10⁷⁴ A.
  Equations diode{1, [](const double* y, double* r) {
                    r[0] = y[0] - (5.0 - 1e3 * 1e-12 * std::expm1(y[0] / 0.025));
                    return true;
                  }};
  for (const double guess : {0.0, -20.0, 1.5}) {
    NewtonSolver solver({}, diode.system());
    double y[] = {guess};
    const NewtonResult result = solver.solve(y);
    ASSERT_EQ(result.status, NewtonStatus::converged) << guess << ": " << to_text(result.status);
    EXPECT_NEAR(1e-9 * std::expm1(y[0] / 0.025), 5.0 - y[0], 1e-9);
  }
}

TEST(Newton, RosenbrocksValleyIsFollowed) {
  Equations rosenbrock{2, [](const double* y, double* r) {
                         r[0] = 10.0 * (y[1] - y[0] * y[0]);
                         r[1] = 1.0 - y[0];
                         return true;
                       }};
  NewtonSolver solver({}, rosenbrock.system());
  double y[] = {-1.2, 1.0};
  ASSERT_EQ(solver.solve(y).status, NewtonStatus::converged);
  EXPECT_NEAR(y[0], 1.0, 1e-9);
  EXPECT_NEAR(y[1], 1.0, 1e-9);
}

TEST(Newton, AWarmStartCostsOneEvaluationOrTwo) {
  double input = 1.0;
  Equations loop{1, [&](const double* y, double* r) {
                   r[0] = y[0] - std::cos(y[0] + input);
                   return true;
                 }};
  NewtonSolver solver({}, loop.system());
  double y[] = {0.0};
  ASSERT_EQ(solver.solve(y).status, NewtonStatus::converged);
  const double solution = y[0];
  const NewtonResult again = solver.solve(y);
  EXPECT_EQ(again.status, NewtonStatus::converged);
  EXPECT_EQ(again.iterations, 0);
  EXPECT_LE(again.evaluations, 3) << "one an unknown tells whether the solution is the only one nearby";
  EXPECT_EQ(y[0], solution);
}

TEST(Newton, WhatHasNoSolutionIsReportedWithItsResidualAndTheGuessIsKept) {
  Equations impossible{2, [](const double* y, double* r) {
                         r[0] = y[1] - 1.0;
                         r[1] = y[0] * y[0] + 1.0;  // at least 1
                         return true;
                       }};
  NewtonSolver solver({}, impossible.system());
  double y[] = {3.0, 0.5};
  const NewtonResult result = solver.solve(y);
  EXPECT_NE(result.status, NewtonStatus::converged);
  EXPECT_GT(result.residual_norm, 0.1);
  EXPECT_TRUE(std::isfinite(result.residual_norm));
  EXPECT_EQ(result.worst_unknown, 1);
  EXPECT_EQ(y[0], 3.0);
  EXPECT_EQ(y[1], 0.5);
}

TEST(Newton, EquationsThatDoNotDetermineTheUnknownsAreSingular) {
  Equations parallel{2, [](const double* y, double* r) {
                       r[0] = y[0] + y[1] - 1.0;
                       r[1] = y[0] + y[1] - 2.0;
                       return true;
                     }};
  NewtonSolver solver({}, parallel.system());
  double y[] = {0.0, 0.0};
  const NewtonResult result = solver.solve(y);
  EXPECT_EQ(result.status, NewtonStatus::singular_jacobian) << to_text(result.status);
  EXPECT_GE(result.residual_norm, 0.5);
}

TEST(Newton, FaultsAndNonFiniteResidualsAreTold) {
  Equations faulty{1, [](const double*, double* r) { return r[0] = 0.0, false; }};
  double y[] = {1.0};
  EXPECT_EQ(NewtonSolver({}, faulty.system()).solve(y).status, NewtonStatus::block_fault);
  Equations undefined{
      1, [](const double* at, double* r) { return r[0] = std::sqrt(-1.0 - at[0] * at[0]), true; }};
  EXPECT_EQ(NewtonSolver({}, undefined.system()).solve(y).status, NewtonStatus::non_finite);
}

TEST(Newton, ASolutionAtTheEdgeOfTheDomainIsReached) {
  Equations root{1, [](const double* y, double* r) { return r[0] = std::sqrt(1.0 - y[0]) - 1e-2, true; }};
  NewtonSolver solver({}, root.system());
  double y[] = {0.0};
  ASSERT_EQ(solver.solve(y).status, NewtonStatus::converged);
  EXPECT_NEAR(y[0], 1.0 - 1e-4, 1e-11);
}

TEST(Newton, NothingAllocatesAfterConstruction) {
  if (!allocations_are_counted()) GTEST_SKIP() << "the sanitizer has its own allocator";
  Equations loop{2, [](const double* y, double* r) {
                   r[0] = y[0] - std::cos(y[1]);
                   r[1] = y[1] - std::sin(y[0]) - 0.3;
                   return true;
                 }};
  NewtonSolver solver({}, loop.system());
  double y[] = {0.0, 0.0};
  const int64_t before = allocations();
  bool good = true;
  for (int k = 0; k < 10; ++k) {
    y[0] = 0.1 * k;
    good = good && solver.solve(y).status == NewtonStatus::converged;
  }
  EXPECT_EQ(allocations() - before, 0);
  EXPECT_TRUE(good);
}

TEST(Newton, SenselessOptionsAreRefused) {
  Equations one{1, [](const double* y, double* r) { return r[0] = y[0], true; }};
  EXPECT_THROW(NewtonSolver({}, AlgebraicSystem{}), std::invalid_argument);
  NewtonOptions options;
  options.tolerance = 0.0;
  EXPECT_THROW(NewtonSolver(options, one.system()), std::invalid_argument);
  options = {};
  options.typical = {1.0, 1.0};
  EXPECT_THROW(NewtonSolver(options, one.system()), std::invalid_argument);
}

}  // namespace
}  // namespace loopwright::testing::newton_test
