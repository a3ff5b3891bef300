// Solutions, compared with closed forms and published reference values.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/engine/solve/systems.h"

namespace loopwright::testing::accuracy_test {
namespace {

class VariableStepAccuracy : public ::testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Every, VariableStepAccuracy, ::testing::ValuesIn(variable_step_methods), test_name);

TEST_P(VariableStepAccuracy, ErrorOfAnOscillatorStaysBelowTheSumOfItsTolerances) {
  // The errors of x'' = -x are not damped: they may accumulate step by step, but not more.
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    FunctionSystem system = oscillator(1.0);
    Solver solver(tolerances(GetParam(), tolerance, tolerance), system.ode());
    const double x0[] = {1.0, 0.0};
    solver.start(0.0, x0);
    for (int k = 1; k <= 20; ++k) {
      const double t = k * std::numbers::pi;
      ASSERT_EQ(solver.advance(t).status, SolverStatus::reached_stop);
      const double allowed = 2.0 * tolerance * static_cast<double>(solver.statistics().steps);
      EXPECT_NEAR(solver.x()[0], std::cos(t), allowed) << tolerance;
      EXPECT_NEAR(solver.x()[1], -std::sin(t), allowed) << tolerance;
    }
  }
}

TEST_P(VariableStepAccuracy, DecayMatchesTheExponential) {
  FunctionSystem system = exponential(-3.0);
  Solver solver(tolerances(GetParam(), 1e-9, 1e-13), system.ode());
  const double x0 = 2.0;
  solver.start(1.0, &x0);
  ASSERT_EQ(solver.advance(4.0).status, SolverStatus::reached_stop);
  EXPECT_EQ(solver.t(), 4.0);
  EXPECT_NEAR(solver.x()[0] / (2.0 * std::exp(-9.0)), 1.0, 1e-6);
}

TEST_P(VariableStepAccuracy, ForcedResponseDependsOnTimeInTheRightPlaces) {
  FunctionSystem system{.states = 1, .derivatives = [](double t, const double* x, double* rate) {
                          return rate[0] = -x[0] + std::sin(10.0 * t), true;
                        }};
  Solver solver(tolerances(GetParam(), 1e-9, 1e-11), system.ode());
  const double x0 = 0.0;
  solver.start(0.0, &x0);
  ASSERT_EQ(solver.advance(3.0).status, SolverStatus::reached_stop);
  const double exact = (10.0 * std::exp(-3.0) + std::sin(30.0) - 10.0 * std::cos(30.0)) / 101.0;
  EXPECT_NEAR(solver.x()[0], exact, 1e-7);
}

TEST_P(VariableStepAccuracy, DenseOutputIsAsAccurateAsTheSteps) {
  FunctionSystem system = oscillator(1.0);
  Solver solver(tolerances(GetParam(), 1e-8, 1e-8), system.ode());
  const double x0[] = {1.0, 0.0};
  solver.start(0.0, x0);
  SolverStatus status = SolverStatus::stepped;
  while (status == SolverStatus::stepped) {
    status = solver.step(2.0 * std::numbers::pi).status;
    ASSERT_TRUE(succeeded(status));
    for (int k = 0; k <= 8; ++k) {
      const double t = solver.step_begin() + k / 8.0 * (solver.t() - solver.step_begin());
      double x[2];
      solver.interpolate(t, x);
      EXPECT_NEAR(x[0], std::cos(t), 2e-6) << t;
      EXPECT_NEAR(x[1], -std::sin(t), 2e-6) << t;
    }
  }
}

TEST_P(VariableStepAccuracy, PolynomialOfDegreeOneIsExact) {
  FunctionSystem system{
      .states = 1, .derivatives = [](double, const double*, double* rate) { return rate[0] = 0.5, true; }};
  Solver solver(tolerances(GetParam(), 1e-6, 1e-9), system.ode());
  const double x0 = 1.0;
  solver.start(0.0, &x0);
  ASSERT_EQ(solver.advance(8.0).status, SolverStatus::reached_stop);
  EXPECT_NEAR(solver.x()[0], 5.0, 1e-13);
}

/// Largest errors at the ends of the steps and halfway between them.
struct FixedStepErrors {
  double end = 0.0, between = 0.0;
};

/// dopri5 on x = (1 / cosh t, -tanh t), with constant steps h.
FixedStepErrors dormand_prince_errors(double h) {
  FunctionSystem system{.states = 2, .derivatives = [](double, const double* x, double* rate) {
                          rate[0] = x[0] * x[1];
                          rate[1] = -x[0] * x[0];
                          return true;
                        }};
  SolverOptions options = tolerances(Method::dopri5, 0.5, 1e3);  // nothing limits the step
  options.initial_step = options.maximum_step = h;
  Solver solver(options, system.ode());
  const double x0[] = {1.0, 0.0};
  solver.start(0.0, x0);
  FixedStepErrors errors;
  while (solver.t() < 1.0) {
    EXPECT_TRUE(succeeded(solver.step(1.0).status));
    double x[2];
    const double t = 0.5 * (solver.step_begin() + solver.t());
    solver.interpolate(t, x);
    errors.between = std::fmax(errors.between, std::fabs(x[0] - 1.0 / std::cosh(t)));
    errors.end = std::fmax(errors.end, std::fabs(solver.x()[0] - 1.0 / std::cosh(solver.t())));
  }
  return errors;
}

TEST(DormandPrince, IsOfFifthOrderAndItsDenseOutputOfFourth) {
  const FixedStepErrors coarse = dormand_prince_errors(1.0 / 32), fine = dormand_prince_errors(1.0 / 64);
  EXPECT_NEAR(std::log2(coarse.end / fine.end), 5.0, 0.4);
  EXPECT_GT(std::log2(coarse.between / fine.between), 3.9);
}

TEST(Bdf, FollowsAStiffLinearSystemInFewSteps) {
  // x' = -10⁶ (x - cos t): after the boundary layer the solution is cos t, to 1e-6.
  FunctionSystem system{.states = 1, .derivatives = [](double t, const double* x, double* rate) {
                          return rate[0] = -1e6 * (x[0] - std::cos(t)), true;
                        }};
  Solver solver(tolerances(Method::cvode_bdf, 1e-6, 1e-9), system.ode());
  const double x0 = 0.0;
  solver.start(0.0, &x0);
  ASSERT_EQ(solver.advance(10.0).status, SolverStatus::reached_stop);
  EXPECT_NEAR(solver.x()[0], std::cos(10.0), 1e-4);
  EXPECT_LT(solver.statistics().steps, 1000);
  EXPECT_GT(solver.statistics().jacobian_evaluations, 0);
}

TEST(Bdf, VanDerPolEndsOnThePublishedValues) {
  // Test Set for IVP Solvers, problem vdpol: μ = 1000, t = 2000.
  FunctionSystem system{.states = 2, .derivatives = [](double, const double* x, double* rate) {
                          rate[0] = x[1];
                          rate[1] = 1000.0 * (1.0 - x[0] * x[0]) * x[1] - x[0];
                          return true;
                        }};
  SolverOptions options = tolerances(Method::cvode_bdf, 1e-9, 1e-9);
  options.absolute_tolerances = {1e-9, 1e-12};
  Solver solver(options, system.ode());
  const double x0[] = {2.0, 0.0};
  solver.start(0.0, x0);
  ASSERT_EQ(solver.advance(2000.0).status, SolverStatus::reached_stop);
  EXPECT_NEAR(solver.x()[0], 1.706167732170469, 1e-6);
  EXPECT_NEAR(solver.x()[1], -0.8928097010248125e-3, 1e-9);
}

FunctionSystem robertson() {
  return {.states = 3, .derivatives = [](double, const double* x, double* rate) {
            rate[0] = -0.04 * x[0] + 1e4 * x[1] * x[2];
            rate[2] = 3e7 * x[1] * x[1];
            rate[1] = -rate[0] - rate[2];
            return true;
          }};
}

TEST(Bdf, RobertsonPassesThePublishedTable) {
  // Output of the LSODE demonstration program, seven digits, of which the last contain its tolerance of 1e-4.
  struct Row {
    double t, x[3];
  };
  constexpr Row table[] = {{4e-1, {9.851712e-01, 3.386380e-05, 1.479493e-02}},
                           {4e+0, {9.055333e-01, 2.240655e-05, 9.444430e-02}},
                           {4e+1, {7.158403e-01, 9.186334e-06, 2.841505e-01}},
                           {4e+2, {4.505250e-01, 3.222964e-06, 5.494717e-01}},
                           {4e+3, {1.831975e-01, 8.941774e-07, 8.168016e-01}}};
  FunctionSystem system = robertson();
  SolverOptions options = tolerances(Method::cvode_bdf, 1e-9, 1e-9);
  options.absolute_tolerances = {1e-16, 1e-20, 1e-16};  // the states end at 1e-8, 1e-13 and 1
  Solver solver(options, system.ode());
  const double x0[] = {1.0, 0.0, 0.0};
  solver.start(0.0, x0);
  for (const Row& row : table) {
    ASSERT_EQ(solver.advance(row.t).status, SolverStatus::reached_stop);
    for (size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(solver.x()[i] / row.x[i], 1.0, 2e-4) << row.t << " state " << i;
  }
  // Test Set for IVP Solvers, problem rober: t = 10¹¹.
  ASSERT_EQ(solver.advance(1e11).status, SolverStatus::reached_stop);
  EXPECT_NEAR(solver.x()[0] / 0.2083340149701255e-07, 1.0, 1e-6);
  EXPECT_NEAR(solver.x()[1] / 0.8333360770334713e-13, 1.0, 1e-6);
  EXPECT_NEAR(solver.x()[2], 0.9999999791665050, 1e-9);
}

TEST(Stiffness, DormandPrinceSaysSoAndNamesTheFastState) {
  FunctionSystem system{.states = 3, .derivatives = [](double t, const double* x, double* rate) {
                          rate[0] = x[1];
                          rate[1] = -x[0];
                          rate[2] = -1e4 * (x[2] - std::cos(t));
                          return true;
                        }};
  Solver solver(tolerances(Method::dopri5, 1e-6, 1e-9), system.ode());
  const double x0[] = {1.0, 0.0, 0.0};
  solver.start(0.0, x0);
  ASSERT_EQ(solver.advance(1.0).status, SolverStatus::reached_stop);
  EXPECT_TRUE(solver.statistics().stiff);
  EXPECT_EQ(solver.statistics().stiffest_state, 2);
}

TEST(Stiffness, IsNotSeenInAnOscillatorWhereAccuracySetsTheStep) {
  FunctionSystem system = oscillator(100.0);
  Solver solver(tolerances(Method::dopri5, 1e-6, 1e-9), system.ode());
  const double x0[] = {1.0, 0.0};
  solver.start(0.0, x0);
  ASSERT_EQ(solver.advance(10.0).status, SolverStatus::reached_stop);
  EXPECT_FALSE(solver.statistics().stiff);
  EXPECT_EQ(solver.statistics().stiffest_state, -1);
}

}  // namespace
}  // namespace loopwright::testing::accuracy_test
