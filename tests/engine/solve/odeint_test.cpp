// dopri5, compared with the Dormand-Prince method of boost::odeint: independent coefficients, error control
// and dense output.
#include <gtest/gtest.h>

#include <boost/numeric/odeint.hpp>
#include <cmath>

#include "tests/engine/solve/systems.h"

namespace loopwright::odeint_test {
namespace {

namespace odeint = boost::numeric::odeint;
using State = std::vector<double>;
using Function = std::function<void(double t, const State& x, State& rate)>;

struct Problem {
  const char* name;
  State start;
  double stop;
  Function rate;
};

const Problem problems[] = {
    {"van der Pol",
     {2, 0},
     20,
     [](double, const State& x, State& rate) {
       rate[0] = x[1];
       rate[1] = 5 * (1 - x[0] * x[0]) * x[1] - x[0];
     }},
    {"Kepler",
     {0.4, 0, 0, 2},
     20,
     [](double, const State& x, State& rate) {
       const double r = std::hypot(x[0], x[1]), pull = 1 / (r * r * r);
       rate = {x[2], x[3], -pull * x[0], -pull * x[1]};
     }},
    {"driven pendulum",
     {0, 1},
     15,
     [](double t, const State& x, State& rate) {
       rate[0] = x[1];
       rate[1] = -std::sin(x[0]) - 0.2 * x[1] + 0.3 * std::cos(1.3 * t);
     }},
};

/// The solution of odeint at evenly spaced times.
std::vector<State> theirs(const Problem& problem, double tolerance, int rows) {
  auto stepper = odeint::make_dense_output(tolerance, tolerance, odeint::runge_kutta_dopri5<State>());
  State x = problem.start;
  std::vector<State> found;
  const double every = problem.stop / rows;
  odeint::integrate_const(
      stepper, [&](const State& at, State& rate, double t) { problem.rate(t, at, rate); }, x, 0.0,
      problem.stop + every / 2, every, [&](const State& at, double) { found.push_back(at); });
  return found;
}

std::vector<State> ours(const Problem& problem, double tolerance, int rows, int64_t& evaluations) {
  const size_t n = problem.start.size();
  testing::FunctionSystem system{.states = int(n),
                                 .derivatives = [&](double t, const double* x, double* rate) {
                                   State result(n);
                                   problem.rate(t, State(x, x + n), result);
                                   std::copy(result.begin(), result.end(), rate);
                                   return true;
                                 }};
  Solver solver({.relative_tolerance = tolerance, .absolute_tolerance = tolerance}, system.ode());
  solver.start(0, problem.start.data());
  std::vector<State> found{problem.start};
  while (solver.t() < problem.stop) {
    EXPECT_TRUE(succeeded(solver.step(problem.stop).status));
    for (double t;
         (t = problem.stop / rows * double(found.size())) <= solver.t() && found.size() <= size_t(rows);) {
      found.emplace_back(n);
      solver.interpolate(t, found.back().data());
    }
  }
  evaluations = solver.statistics().derivative_evaluations;
  return found;
}

TEST(Odeint, AgreesWithItsDormandPrince) {
  constexpr int rows = 64;
  for (const Problem& problem : problems) {
    int64_t evaluations = 0;
    const auto one = ours(problem, 1e-11, rows, evaluations), other = theirs(problem, 1e-12, rows);
    ASSERT_EQ(one.size(), size_t(rows) + 1) << problem.name;
    ASSERT_GE(other.size(), size_t(rows) + 1) << problem.name;
    for (int row = 0; row <= rows; ++row)
      for (size_t i = 0; i < problem.start.size(); ++i)
        EXPECT_NEAR(one[size_t(row)][i], other[size_t(row)][i], 1e-7) << problem.name << " row " << row;
  }
}

TEST(Odeint, NeedsNoMoreEvaluationsForTheSameError) {
  for (const Problem& problem : problems) {
    int64_t evaluations = 0, tight_evaluations = 0, their_evaluations = 0;
    const State exact = ours(problem, 1e-12, 1, tight_evaluations).back(),
                mine = ours(problem, 1e-7, 1, evaluations).back();
    State x = problem.start;
    odeint::integrate_adaptive(
        odeint::make_controlled(1e-7, 1e-7, odeint::runge_kutta_dopri5<State>()),
        [&](const State& at, State& rate, double t) {
          ++their_evaluations;
          problem.rate(t, at, rate);
        },
        x, 0.0, problem.stop, 1e-3);
    double error = 0, their_error = 0;
    for (size_t i = 0; i < exact.size(); ++i) {
      error = std::max(error, std::abs(mine[i] - exact[i]));
      their_error = std::max(their_error, std::abs(x[i] - exact[i]));
    }
    // The error is of order five in evaluations: the number that reaches the error of odeint.
    const double needed = double(evaluations) * std::pow(error / their_error, 0.2);
    EXPECT_LT(needed, 1.5 * double(their_evaluations)) << problem.name;
  }
}

}  // namespace
}  // namespace loopwright::odeint_test
