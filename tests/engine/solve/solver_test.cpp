// Properties that a run requires of every method: stop times, restarts, failures, repeatability, no
// allocation.
#include "engine/solve/solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "engine/solve/stepper.h"
#include "tests/engine/solve/allocations.h"
#include "tests/engine/solve/systems.h"

namespace loopwright::testing::solver_test {
namespace {

class SolverContract : public ::testing::TestWithParam<Method> {
 protected:
  SolverOptions options() const { return tolerances(GetParam(), 1e-7, 1e-9); }
};
INSTANTIATE_TEST_SUITE_P(Every, SolverContract, ::testing::ValuesIn(variable_step_methods), test_name);

TEST_P(SolverContract, NothingIsEvaluatedOutsideTheStretchAndItsEndIsMetExactly) {
  FunctionSystem system = oscillator(30.0);
  system.crossings = 1;
  system.crossing_values = [](double, const double* x, double* value) { return value[0] = x[0] - 2.0, true; };
  Solver solver(options(), system.ode());
  const double x0[] = {1.0, 0.0};
  solver.start(0.1, x0);
  for (int k = 1; k <= 300; ++k) {
    const double begin = solver.t(), stop = 0.1 + 0.0137 * k;
    system.earliest = 1e9, system.latest = -1e9;
    ASSERT_EQ(solver.advance(stop).status, SolverStatus::reached_stop);
    EXPECT_EQ(solver.t(), stop);
    EXPECT_GE(system.earliest, begin);
    EXPECT_LE(system.latest, stop);
    solver.restart(stop, solver.x().data());
  }
  EXPECT_NEAR(solver.x()[0], std::cos(30.0 * (solver.t() - 0.1)), 1e-3);
}

TEST_P(SolverContract, ADiscontinuityAtTheStopTimeIsIntegratedExactlyOnBothSides) {
  double force = 1.0;
  FunctionSystem system{.states = 1, .derivatives = [&](double, const double* x, double* rate) {
                          return rate[0] = 50.0 * (force - x[0]), true;
                        }};
  Solver solver(tolerances(GetParam(), 1e-9, 1e-12), system.ode());
  double x = 0.0, exact = 0.0;
  solver.start(0.0, &x);
  for (int k = 1; k <= 100; ++k) {
    ASSERT_EQ(solver.advance(0.01 * k).status, SolverStatus::reached_stop);
    exact = force + (exact - force) * std::exp(-50.0 * (0.01 * k - 0.01 * (k - 1)));
    EXPECT_NEAR(solver.x()[0], exact, 1e-7);
    force = -force;
    x = solver.x()[0];
    solver.restart(solver.t(), &x);
  }
  EXPECT_EQ(solver.statistics().restarts, 100);
}

TEST_P(SolverContract, StretchesOfAFewRoundingsArePossible) {
  FunctionSystem system = exponential(-1.0);
  Solver solver(options(), system.ode());
  const double x0 = 1.0;
  solver.start(1.0, &x0);
  double stop = 1.0;
  for (int k = 0; k < 20; ++k) {
    stop = std::nextafter(stop, 2.0);
    ASSERT_EQ(solver.advance(stop).status, SolverStatus::reached_stop);
    EXPECT_EQ(solver.t(), stop);
    EXPECT_NEAR(solver.x()[0], 1.0, 1e-14);
    if (k % 2 == 0) solver.restart(stop, solver.x().data());
  }
  ASSERT_EQ(solver.advance(2.0).status, SolverStatus::reached_stop);
  EXPECT_NEAR(solver.x()[0], std::exp(-1.0), 1e-6);
}

TEST_P(SolverContract, AStopTimeInThePastIsRefusedAndThePresentOneIsReached) {
  FunctionSystem system = exponential(-1.0);
  Solver solver(options(), system.ode());
  const double x0 = 1.0;
  solver.start(1.0, &x0);
  EXPECT_EQ(solver.advance(0.5).status, SolverStatus::bad_stop);
  EXPECT_EQ(solver.advance(std::nan("")).status, SolverStatus::bad_stop);
  EXPECT_EQ(solver.advance(std::numeric_limits<double>::infinity()).status, SolverStatus::bad_stop);
  EXPECT_EQ(solver.advance(1.0).status, SolverStatus::reached_stop);
  EXPECT_EQ(system.evaluations, 0);
}

TEST_P(SolverContract, AStopTimeFarAwayLeavesRoomForShortSteps) {
  FunctionSystem system = exponential(-1e6);
  Solver solver(options(), system.ode());
  const double x0 = 1.0;
  solver.start(0.0, &x0);
  while (solver.t() < 1e-6) {
    ASSERT_EQ(solver.step(1e11).status, SolverStatus::stepped);
    EXPECT_NEAR(solver.x()[0], std::exp(-1e6 * solver.t()), 1e-4);
  }
}

TEST_P(SolverContract, ANonFiniteDerivativeIsReportedWithTheStateBeforeIt) {
  FunctionSystem system{.states = 2, .derivatives = [](double t, const double* x, double* rate) {
                          rate[0] = -x[0];
                          rate[1] = t > 0.5 ? std::nan("") : 1.0;
                          return true;
                        }};
  Solver solver(options(), system.ode());
  const double x0[] = {1.0, 0.0};
  solver.start(0.0, x0);
  const Advance result = solver.advance(1.0);
  EXPECT_EQ(result.status, SolverStatus::non_finite);
  EXPECT_GT(result.t, 0.4);
  EXPECT_LE(result.t, 0.5);
  EXPECT_NEAR(solver.x()[1], result.t, 1e-6);
  EXPECT_EQ(solver.worst_state(), 1);
  EXPECT_LT(system.evaluations, 5000);
}

TEST_P(SolverContract, ANonFiniteDerivativeAtTheStartIsReportedAtOnce) {
  FunctionSystem system{.states = 2, .derivatives = [](double, const double*, double* rate) {
                          rate[0] = 0.0;
                          rate[1] = std::numeric_limits<double>::infinity();
                          return true;
                        }};
  Solver solver(options(), system.ode());
  const double x0[] = {1.0, 0.0};
  solver.start(0.0, x0);
  const Advance result = solver.advance(1.0);
  EXPECT_EQ(result.status, SolverStatus::non_finite);
  EXPECT_EQ(result.t, 0.0);
  EXPECT_EQ(solver.worst_state(), 1);
}

TEST_P(SolverContract, ABlockFaultIsReportedWithTheStateBeforeIt) {
  FunctionSystem system{.states = 1, .derivatives = [](double t, const double*, double* rate) {
                          return rate[0] = 1.0, t <= 0.5;
                        }};
  Solver solver(options(), system.ode());
  const double x0 = 0.0;
  solver.start(0.0, &x0);
  const Advance result = solver.advance(1.0);
  EXPECT_EQ(result.status, SolverStatus::block_fault);
  EXPECT_LE(result.t, 0.5);
  EXPECT_NEAR(solver.x()[0], result.t, 1e-6);
}

TEST_P(SolverContract, ATrialBeyondTheDomainIsTakenBackAndTheRunGoesOn) {
  // x' = -√x from 1: x = (1 - t/2)². Long trial steps reach negative values, for which the root is undefined.
  FunctionSystem system{.states = 1, .derivatives = [](double, const double* x, double* rate) {
                          return rate[0] = -std::sqrt(x[0]), true;
                        }};
  SolverOptions bold = options();
  bold.initial_step = 1.9;
  Solver solver(bold, system.ode());
  const double x0 = 1.0;
  solver.start(0.0, &x0);
  ASSERT_EQ(solver.advance(1.9).status, SolverStatus::reached_stop);
  EXPECT_NEAR(solver.x()[0], 0.0025, 1e-6);
}

TEST_P(SolverContract, ABlowUpEndsWithAReasonAndAFiniteState) {
  FunctionSystem system{.states = 1, .derivatives = [](double, const double* x, double* rate) {
                          return rate[0] = x[0] * x[0], true;
                        }};
  Solver solver(options(), system.ode());
  const double x0 = 1.0;
  solver.start(0.0, &x0);
  const Advance result = solver.advance(2.0);  // infinite at t = 1
  EXPECT_FALSE(succeeded(result.status)) << to_text(result.status);
  EXPECT_NEAR(result.t, 1.0, 1e-3);
  EXPECT_TRUE(std::isfinite(solver.x()[0]));
  EXPECT_GT(solver.x()[0], 1000.0);
}

TEST_P(SolverContract, AStuckRunEndsAfterItsSteps) {
  FunctionSystem system = oscillator(1e4);
  SolverOptions few = options();
  few.maximum_steps_between_stops = 100;
  Solver solver(few, system.ode());
  const double x0[] = {1.0, 0.0};
  solver.start(0.0, x0);
  EXPECT_EQ(solver.advance(1.0).status, SolverStatus::too_many_steps);
  EXPECT_GT(solver.t(), 0.0);
  EXPECT_LE(solver.statistics().trials(), 110);
}

TEST_P(SolverContract, TheStepCountStartsAnewAtEveryStop) {
  FunctionSystem system = oscillator(10.0);
  SolverOptions few = options();
  few.maximum_steps_between_stops = 100;
  Solver solver(few, system.ode());
  const double x0[] = {1.0, 0.0};
  solver.start(0.0, x0);
  for (int k = 1; k <= 200; ++k) ASSERT_EQ(solver.advance(0.1 * k).status, SolverStatus::reached_stop);
  EXPECT_GT(solver.statistics().steps, 200);
}

TEST_P(SolverContract, NoStepIsLongerThanPermitted) {
  FunctionSystem system = exponential(-1e-3);
  SolverOptions short_steps = options();
  short_steps.maximum_step = 0.3;
  Solver solver(short_steps, system.ode());
  const double x0 = 1.0;
  solver.start(0.0, &x0);
  Advance result{};
  do {
    result = solver.step(10.0);
    ASSERT_TRUE(succeeded(result.status));
    EXPECT_LE(result.t - solver.step_begin(), 0.3 * (1.0 + 1e-12));
  } while (result.status == SolverStatus::stepped);
}

TEST_P(SolverContract, StartForgetsSoThatRunsRepeatBitByBit) {
  FunctionSystem system = oscillator(20.0);
  system.crossings = 1;
  system.crossing_values = [](double, const double* x, double* value) { return value[0] = x[0] - 0.3, true; };
  Solver solver(options(), system.ode());
  const double x0[] = {1.0, 0.0};
  const auto run = [&] {
    std::vector<double> trace;
    solver.start(0.0, x0);
    for (int k = 1; k <= 20; ++k) {
      while (solver.advance(0.05 * k).status == SolverStatus::event) trace.push_back(solver.t());
      trace.push_back(solver.x()[0]);
      trace.push_back(solver.x()[1]);
      if (k % 3 == 0) solver.restart(solver.t(), solver.x().data());
    }
    trace.push_back(static_cast<double>(solver.statistics().derivative_evaluations));
    trace.push_back(static_cast<double>(solver.statistics().restarts));
    return trace;
  };
  const std::vector<double> first = run();
  solver.advance(3.3);
  const std::vector<double> second = run();
  ASSERT_EQ(first.size(), second.size());
  EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof(double)), 0);
}

TEST_P(SolverContract, AMovedSolverGoesOn) {
  FunctionSystem system = exponential(-1.0);
  Solver first(options(), system.ode());
  const double x0 = 1.0;
  first.start(0.0, &x0);
  ASSERT_EQ(first.advance(0.5).status, SolverStatus::reached_stop);
  Solver second = std::move(first);
  EXPECT_NEAR(second.x()[0], std::exp(-0.5), 1e-5);
  ASSERT_EQ(second.advance(1.0).status, SolverStatus::reached_stop);
  EXPECT_NEAR(second.x()[0], std::exp(-1.0), 1e-5);
}

TEST_P(SolverContract, NothingAllocatesAfterConstruction) {
  if (!allocations_are_counted()) GTEST_SKIP() << "the sanitizer has its own allocator";
  FunctionSystem system = oscillator(20.0);
  system.crossings = 2;
  system.crossing_values = [](double, const double* x, double* value) {
    value[0] = x[0];
    value[1] = x[1];
    return true;
  };
  Solver solver(options(), system.ode());
  const double x0[] = {1.0, 0.0};
  bool good = true;
  int events = 0;
  const int64_t before = allocations();
  solver.start(0.0, x0);
  for (int k = 1; k <= 50; ++k) {
    Advance result{};
    while ((result = solver.advance(0.02 * k)).status == SolverStatus::event) ++events;
    good = good && result.status == SolverStatus::reached_stop;
    solver.restart(solver.t(), solver.x().data());
  }
  EXPECT_EQ(allocations() - before, 0);
  EXPECT_TRUE(good);
  EXPECT_GT(events, 10);
}

TEST(DormandPrinceRestarts, CostOneEvaluationAndKeepTheStepSize) {
  // One step a millisecond is sufficient: 1 evaluation for the restart, 6 for the step.
  FunctionSystem system = oscillator(20.0);
  Solver solver(tolerances(Method::dopri5, 1e-8, 1e-10), system.ode());
  const double x0[] = {1.0, 0.0};
  solver.start(0.0, x0);
  ASSERT_EQ(solver.advance(0.1).status, SolverStatus::reached_stop);
  const int64_t before = system.evaluations;
  for (int k = 101; k <= 1100; ++k) {
    solver.restart(solver.t(), solver.x().data());
    ASSERT_EQ(solver.advance(0.001 * k).status, SolverStatus::reached_stop);
  }
  EXPECT_EQ(system.evaluations - before, 7 * 1000);
}

TEST(DormandPrinceRestarts, AStretchCutShortDoesNotShrinkTheNextSteps) {
  FunctionSystem system = oscillator(20.0);
  Solver solver(tolerances(Method::dopri5, 1e-8, 1e-10), system.ode());
  const double x0[] = {1.0, 0.0};
  solver.start(0.0, x0);
  ASSERT_EQ(solver.advance(0.1).status, SolverStatus::reached_stop);
  for (int k = 1; k <= 100; ++k) {
    ASSERT_EQ(solver.advance(0.1 + 0.01 * k - 1e-12).status, SolverStatus::reached_stop);
    solver.restart(solver.t(), solver.x().data());
    ASSERT_EQ(solver.advance(0.1 + 0.01 * k).status, SolverStatus::reached_stop);
    solver.restart(solver.t(), solver.x().data());
    const int64_t before = solver.statistics().trials();
    ASSERT_EQ(solver.advance(0.1 + 0.01 * k + 0.001).status, SolverStatus::reached_stop);
    EXPECT_EQ(solver.statistics().trials() - before, 1);
  }
}

/// A method that reports a step without advancing.
class Liar : public Stepper {
 public:
  Liar(const OdeSystem& system, double time, double state)
      : Stepper({}, system), time_(time), state_(state) {}
  SolverStatus step(double) override {
    std::vector<double> end{state_};
    accept(time_, end);
    return SolverStatus::stepped;
  }
  int worst_state() const override { return -1; }

 private:
  void forget_all() override {}
  void forget_history() override {}
  void interpolate_within(double, double*) const override {}
  double time_, state_;
};

TEST(SolverChecks, AMethodThatClaimsSuccessIsNotBelieved) {
  struct Claim {
    double time, state;
    SolverStatus verdict;
  };
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Claim& claim :
       {Claim{0.5, 1.0, SolverStatus::stepped}, Claim{0.0, 1.0, SolverStatus::wrong_answer},
        Claim{-1.0, 1.0, SolverStatus::wrong_answer}, Claim{1.5, 1.0, SolverStatus::wrong_answer},
        Claim{std::nan(""), 1.0, SolverStatus::wrong_answer},
        Claim{0.5, infinity, SolverStatus::wrong_answer},
        Claim{0.5, std::nan(""), SolverStatus::wrong_answer}}) {
    FunctionSystem system = exponential(-1.0);
    Solver solver(std::make_unique<Liar>(system.ode(), claim.time, claim.state), {}, system.ode());
    const double x0 = 7.0;
    solver.start(0.0, &x0);
    EXPECT_EQ(solver.step(1.0).status, claim.verdict) << claim.time << ' ' << claim.state;
    if (claim.verdict == SolverStatus::wrong_answer) {
      EXPECT_EQ(solver.x()[0], 7.0) << "the last good state stands";
    }
  }
}

TEST(SolverOptions, EveryProblemIsNamedAtOnce) {
  SolverOptions options;
  options.method = Method::rk4;
  options.relative_tolerance = 0.0;
  options.absolute_tolerance = -1.0;
  options.absolute_tolerances = {1e-9, 0.0};
  options.initial_step = std::nan("");
  options.maximum_step = 0.0;
  options.maximum_steps_between_stops = 0;
  options.crossing_samples = 0;
  EXPECT_EQ(options.problems(3).size(), 9u);
  EXPECT_TRUE(SolverOptions{}.problems(3).empty());
  FunctionSystem system = exponential(1.0);
  EXPECT_THROW(Solver(options, system.ode()), std::invalid_argument);
  EXPECT_THROW(Solver(SolverOptions{}, OdeSystem{}), std::invalid_argument);
}

TEST(SolverStatus, EveryStatusHasAText) {
  for (int status = 0; status <= static_cast<int>(SolverStatus::bad_stop); ++status) {
    EXPECT_NE(to_text(static_cast<SolverStatus>(status)), "unknown solver status");
  }
}

}  // namespace
}  // namespace loopwright::testing::solver_test
