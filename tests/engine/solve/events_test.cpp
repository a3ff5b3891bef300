// Location of the sign changes of crossing functions, and changes that do not count as an event.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/engine/solve/systems.h"

namespace loopwright::testing::events_test {
namespace {

constexpr double gravity = 9.81;  // m/s²

class Events : public ::testing::TestWithParam<Method> {
 protected:
  SolverOptions options() const { return tolerances(GetParam(), 1e-11, 1e-13); }
};
INSTANTIATE_TEST_SUITE_P(Every, Events, ::testing::ValuesIn(variable_step_methods), test_name);

/// A ball above a floor; the crossing is its height.
FunctionSystem ball() {
  return {.states = 2,
          .derivatives =
              [](double, const double* x, double* rate) {
                rate[0] = x[1];
                rate[1] = -gravity;
                return true;
              },
          .crossings = 1,
          .crossing_values = [](double, const double* x, double* value) { return value[0] = x[0], true; }};
}

/// Times [s] of the bounces of a ball dropped from 1 m that keeps `restitution` of its speed. `place` is the
/// height at which it is placed at a bounce; NaN: where it was found.
std::vector<double> bounce_times(const SolverOptions& options, int bounces, double restitution, double place,
                                 const Crossing wanted) {
  FunctionSystem system = ball();
  Solver solver(options, system.ode());
  double x[] = {1.0, 0.0};
  solver.start(0.0, x);
  std::vector<double> times;
  while (std::ssize(times) < bounces) {
    const Advance result = solver.advance(100.0, &wanted);
    EXPECT_EQ(result.status, SolverStatus::event) << "bounce " << times.size();
    if (result.status != SolverStatus::event) break;
    if (solver.fired()[0] > 0) {  // left a rounding error below the floor, it rises through it
      EXPECT_EQ(wanted, Crossing::either);
      EXPECT_LT(result.t - times.back(), 1e-12);
      solver.restart(result.t, solver.x().data());
      continue;
    }
    EXPECT_EQ(solver.fired()[0], -1);
    times.push_back(result.t);
    x[0] = std::isnan(place) ? solver.x()[0] : place;
    x[1] = -restitution * solver.x()[1];
    solver.restart(result.t, x);
    solver.restart(result.t, x);  // a sample at the same instant
  }
  return times;
}

double exact_bounce_time(int bounce, double restitution) {
  const double fall = std::sqrt(2.0 / gravity);
  double t = fall;
  for (int k = 1; k <= bounce; ++k) t += 2.0 * fall * std::pow(restitution, k);
  return t;
}

TEST_P(Events, BouncesAreFoundToANanosecondWhereverTheDriverPutsTheBall) {
  for (const double place : {0.0, std::numeric_limits<double>::quiet_NaN()}) {
    for (const Crossing wanted : {Crossing::falling, Crossing::either}) {
      const std::vector<double> times = bounce_times(options(), 11, 0.8, place, wanted);
      ASSERT_EQ(times.size(), 11u);
      for (int k = 0; k <= 10; ++k) {
        EXPECT_NEAR(times[static_cast<size_t>(k)], exact_bounce_time(k, 0.8), 1e-9) << "bounce " << k;
      }
    }
  }
}

TEST_P(Events, ACrossingThatComesStraightBackFiresAgain) {
  // dx/dt = -sign(x), the sign decided at events only: it cannot rest at zero, and every return must be
  // reported.
  double sign = 1.0;
  FunctionSystem system =
      clock_with(1, [](double, const double* x, double* value) { return value[0] = x[0], true; });
  system.derivatives = [&](double, const double*, double* rate) { return rate[0] = -sign, true; };
  Solver solver(options(), system.ode());
  double x = 1.0;
  solver.start(0.0, &x);
  for (int k = 0; k < 50; ++k) {
    ASSERT_EQ(solver.advance(3.0).status, SolverStatus::event) << k;
    x = solver.x()[0];
    ASSERT_EQ(solver.fired()[0], x > 0.0 ? 1 : -1) << k;
    sign = x > 0.0 ? 1.0 : -1.0;
    solver.restart(solver.t(), &x);
  }
  EXPECT_NEAR(solver.t(), 1.0, 1e-9);
  EXPECT_NEAR(x, 0.0, 1e-9);
}

TEST_P(Events, ABallThatHardlyBouncesDoesNotFallThroughTheFloor) {
  // Hops of 1e-10 m; with an absolute tolerance of 1e-13 m no better result can be expected. The polynomial
  // between bounces is exact for dopri5, which therefore continues to hops of 1e-15 m.
  const int bounces = GetParam() == Method::dopri5 ? 80 : 50;
  const std::vector<double> times = bounce_times(options(), bounces, 0.8, 0.0, Crossing::falling);
  ASSERT_EQ(std::ssize(times), bounces);
  // An error of the tolerance in height is an error of 2e-9 s at the last landing and of 6e-5 m/s, and these
  // accumulate.
  EXPECT_NEAR(times.back(), exact_bounce_time(bounces - 1, 0.8), 1e-7);
}

TEST_P(Events, EveryZeroOfASineIsFoundWithoutRestarts) {
  FunctionSystem system = oscillator(1.0);
  system.crossings = 1;
  system.crossing_values = [](double, const double* x, double* value) { return value[0] = x[0], true; };
  Solver solver(options(), system.ode());
  const double x0[] = {0.0, 1.0};
  solver.start(0.0, x0);
  for (int k = 1; k <= 10; ++k) {
    const Advance result = solver.advance(32.0);
    ASSERT_EQ(result.status, SolverStatus::event);
    EXPECT_NEAR(result.t, k * std::numbers::pi, 1e-8);
    EXPECT_EQ(solver.fired()[0], k % 2 == 0 ? 1 : -1);
    EXPECT_LE(solver.x()[0] * (k % 2 == 0 ? -1 : 1), 0.0) << "the new sign is not there yet";
  }
  EXPECT_EQ(solver.advance(32.0).status, SolverStatus::reached_stop);
  EXPECT_EQ(solver.statistics().events, 10);
}

TEST_P(Events, OnlyTheWantedDirectionCounts) {
  FunctionSystem system = oscillator(1.0);
  system.crossings = 1;
  system.crossing_values = [](double, const double* x, double* value) { return value[0] = x[0], true; };
  Solver solver(options(), system.ode());
  const double x0[] = {1.0, 0.0};
  solver.start(0.0, x0);
  const Crossing rising = Crossing::rising;
  const Advance result = solver.advance(10.0, &rising);
  ASSERT_EQ(result.status, SolverStatus::event);
  EXPECT_NEAR(result.t, 1.5 * std::numbers::pi, 1e-8);
  EXPECT_EQ(solver.fired()[0], 1);
}

TEST_P(Events, SimultaneousCrossingsComeAsOneSet) {
  FunctionSystem system = clock_with(4, [](double t, const double* x, double* value) {
    value[0] = x[0] - 1.0;
    value[1] = std::sqrt(2.0) * (1.0 - x[0] * x[0] * x[0]);  // the same instant with another rounding
    value[2] = 10.0 * t - 10.0;
    value[3] = x[0] - 1.001;
    return true;
  });
  Solver solver(options(), system.ode());
  const double x0 = 0.0;
  solver.start(0.0, &x0);
  ASSERT_EQ(solver.advance(2.0).status, SolverStatus::event);
  EXPECT_NEAR(solver.t(), 1.0, 1e-9);
  const std::vector<int8_t> first(solver.fired().begin(), solver.fired().end());
  EXPECT_EQ(first, (std::vector<int8_t>{1, -1, 1, 0}));
  ASSERT_EQ(solver.advance(2.0).status, SolverStatus::event);
  EXPECT_NEAR(solver.t(), 1.001, 1e-9);
  EXPECT_EQ(solver.fired()[3], 1);
  EXPECT_EQ(solver.fired()[0], 0);
}

TEST_P(Events, TheEarliestOfSeveralComesFirst) {
  FunctionSystem system = clock_with(3, [](double, const double* x, double* value) {
    value[0] = x[0] - 0.7;
    value[1] = std::exp(x[0]) - std::exp(0.2);
    value[2] = x[0] * x[0] - 0.25;
    return true;
  });
  Solver solver(options(), system.ode());
  const double x0 = 0.0;
  solver.start(0.0, &x0);
  for (const double expected : {0.2, 0.5, 0.7}) {
    ASSERT_EQ(solver.advance(1.0).status, SolverStatus::event);
    EXPECT_NEAR(solver.t(), expected, 1e-9);
  }
  EXPECT_EQ(solver.advance(1.0).status, SolverStatus::reached_stop);
}

TEST_P(Events, ATouchWithoutChangeOfSignIsNone) {
  FunctionSystem system = clock_with(
      1, [](double t, const double*, double* value) { return value[0] = (t - 0.5) * (t - 0.5), true; });
  Solver solver(options(), system.ode());
  const double x0 = 0.0;
  solver.start(0.0, &x0);
  ASSERT_EQ(solver.advance(0.5).status, SolverStatus::reached_stop) << "exactly zero at the stop";
  EXPECT_EQ(solver.advance(1.0).status, SolverStatus::reached_stop);
  EXPECT_EQ(solver.statistics().events, 0);
}

TEST_P(Events, ThereAndBackWithinOneStepIsSeen) {
  FunctionSystem system = clock_with(
      1, [](double t, const double*, double* value) { return value[0] = (t - 40.0) * (t - 70.0), true; });
  Solver solver(options(), system.ode());
  const double x0 = 0.0;
  solver.start(0.0, &x0);
  ASSERT_EQ(solver.advance(100.0).status, SolverStatus::event);
  EXPECT_NEAR(solver.t(), 40.0, 1e-9);
  ASSERT_EQ(solver.advance(100.0).status, SolverStatus::event);
  EXPECT_NEAR(solver.t(), 70.0, 1e-9);
}

TEST_P(Events, AtTheStopTimeIsNeitherLostNorDoubled) {
  for (const bool restart : {false, true}) {
    FunctionSystem system =
        clock_with(1, [](double t, const double*, double* value) { return value[0] = t - 1.0, true; });
    Solver solver(options(), system.ode());
    const double x0 = 0.0;
    solver.start(0.0, &x0);
    ASSERT_EQ(solver.advance(1.0).status, SolverStatus::reached_stop) << "zero has been reached, not crossed";
    if (restart) solver.restart(1.0, solver.x().data());
    ASSERT_EQ(solver.advance(2.0).status, SolverStatus::event);
    EXPECT_NEAR(solver.t(), 1.0, 1e-9);
    EXPECT_EQ(solver.fired()[0], 1);
    if (restart) solver.restart(solver.t(), solver.x().data());
    EXPECT_EQ(solver.advance(2.0).status, SolverStatus::reached_stop);
    EXPECT_EQ(solver.statistics().events, 1);
  }
}

TEST_P(Events, ARoundingBeforeTheStopTimeIsFoundBeforeIt) {
  const double just_before = std::nextafter(1.0, 0.0);
  FunctionSystem system =
      clock_with(1, [=](double t, const double*, double* value) { return value[0] = t - just_before, true; });
  Solver solver(options(), system.ode());
  const double x0 = 0.0;
  solver.start(0.0, &x0);
  ASSERT_EQ(solver.advance(1.0).status, SolverStatus::event);
  EXPECT_LE(solver.t(), 1.0);
  EXPECT_EQ(solver.advance(1.0).status, SolverStatus::reached_stop);
  EXPECT_EQ(solver.t(), 1.0);
}

TEST_P(Events, ACrossingThatRestsAtZeroDoesNotFireNorCostMuch) {
  FunctionSystem system = clock_with(1, [](double t, const double*, double* value) {
    return value[0] = std::fmax(0.0, t - 1.0) + std::fmin(0.0, t - 0.5), true;  // zero from 0.5 to 1
  });
  Solver solver(options(), system.ode());
  const double x0 = 0.0;
  solver.start(0.5, &x0);
  for (int k = 501; k <= 1000; ++k) {
    ASSERT_EQ(solver.advance(0.001 * k).status, SolverStatus::reached_stop);
    solver.restart(solver.t(), solver.x().data());
  }
  EXPECT_LT(solver.statistics().crossing_evaluations, 500 * 20);
  EXPECT_EQ(solver.advance(2.0).status, SolverStatus::reached_stop) << "it leaves zero for the first time";
}

TEST_P(Events, AreFoundWithoutAnyState) {
  FunctionSystem system =
      clock_with(1, [](double t, const double*, double* value) { return value[0] = std::sin(t), true; });
  system.states = 0;
  system.derivatives = [](double, const double*, double*) { return true; };
  SolverOptions short_steps = options();
  short_steps.maximum_step = 1.0;
  Solver solver(short_steps, system.ode());
  solver.start(1.0, nullptr);
  ASSERT_EQ(solver.advance(10.0).status, SolverStatus::event);
  EXPECT_NEAR(solver.t(), std::numbers::pi, 1e-9);
}

TEST_P(Events, AFaultOrNanInACrossingEndsTheAdvance) {
  FunctionSystem system = clock_with(1, [](double t, const double*, double* value) {
    return value[0] = t > 0.5 ? std::nan("") : 1.0, true;
  });
  Solver solver(options(), system.ode());
  const double x0 = 0.0;
  solver.start(0.0, &x0);
  EXPECT_EQ(solver.advance(1.0).status, SolverStatus::non_finite);
  system.crossing_values = [](double t, const double*, double* value) { return value[0] = 1.0, t < 0.5; };
  solver.start(0.0, &x0);
  EXPECT_EQ(solver.advance(1.0).status, SolverStatus::block_fault);
}

}  // namespace
}  // namespace loopwright::testing::events_test
