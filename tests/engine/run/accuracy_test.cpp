// Solutions of diagrams, compared with closed forms and published values.
#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include "tests/engine/written_diagram.h"
#include "where.h"

namespace loopwright::accuracy_test {
namespace {

/// A mass of 2 kg on a spring of 50 N/m: 5 rad/s, released at 0.1 m.
std::string oscillator(std::string_view solver) {
  return diagram(
      R"("stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "initial_position": {"value": 0.1, "unit": "m"}, "in": {"force": "push.y"}},
    "spring": {"type": "Spring", "stiffness": {"value": 50, "unit": "N/m"}, "in": {"position": "stage.position"}},
    "push": {"type": "Gain", "gain": {"value": -1, "unit": "1"}, "in": {"u": "spring.force"}})",
      solver, R"(, "log": ["stage.position"])");
}

/// Largest error of the position over all rows [m].
double error(const RunResult& result) {
  double worst = 0;
  for (size_t i = 0; i < result.recording.rows(); ++i)
    worst = std::max(
        worst, std::abs(signal(result, "stage.position")[i] - 0.1 * std::cos(5 * signal(result, "time")[i])));
  return worst;
}

TEST(Accuracy, FixedStepMethodsConvergeWithTheirOrder) {
  for (const auto& [method, order] :
       {std::pair{"euler", 1.0}, std::pair{"heun", 2.0}, std::pair{"rk4", 4.0}}) {
    const auto at = [&](double step) {
      return error(run_of(oscillator(
          fmt::format(R"("stop": 1, "method": "{}", "step": {}, "record_step": 0.02)", method, step))));
    };
    const double coarse = at(0.001), fine = at(0.0005);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.05) << method << ": " << coarse << ", " << fine;
  }
}

TEST(Accuracy, VariableStepMethodsKeepTheirTolerance) {
  for (const char* method : {"dopri5", "cvode-bdf", "cvode-adams"})
    for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
      const double e = error(run_of(oscillator(fmt::format(
          R"("stop": 2, "method": "{}", "relative_tolerance": {:g}, "absolute_tolerance": {:g}, "record_step": 0.02)",
          method, tolerance, 0.1 * tolerance))));
      EXPECT_LT(e, 200 * 0.1 * tolerance)
          << method << " at " << tolerance;  // local errors accumulate over two seconds
      EXPECT_GT(e, 0) << method;
    }
}

TEST(Accuracy, DenseOutputDoesNotDependOnTheStepsOfTheSolver) {
  // Steps of about 0.05 s, rows every millisecond: equally accurate between the steps and at their ends.
  const RunResult result = run_of(oscillator(
      R"("stop": 2, "method": "dopri5", "relative_tolerance": 1e-8, "absolute_tolerance": 1e-10, "record_step": 0.001)"));
  EXPECT_EQ(result.recording.rows(), 2001u);
  EXPECT_LT(result.statistics.steps, 400);
  EXPECT_LT(error(result), 1e-7);
  const RunResult coarse = run_of(oscillator(
      R"("stop": 2, "method": "dopri5", "relative_tolerance": 1e-8, "absolute_tolerance": 1e-10, "record_step": 0.1)"));
  EXPECT_EQ(coarse.statistics.steps, result.statistics.steps) << "rows cost no steps";
  EXPECT_EQ(signal(coarse, "stage.position").back(), signal(result, "stage.position").back());
}

TEST(Accuracy, AnRcChainFollowsItsClosedForm) {
  // R = 1 kΩ, C = 1 µF behind a step of 5 V at 1 ms: 5 (1 - exp(-(t - 1 ms)/1 ms)).
  const RunResult result = run_of(diagram(
      R"("source": {"type": "Step", "time": 0.001, "after": {"value": 5, "unit": "V"}},
    "across": {"type": "Sum", "signs": "+-", "in": {"terms": ["source.y", "capacitor.y"]}}, "current": {"type": "Gain", "gain": {"value": 0.001, "unit": "A/V"}, "in": {"u": "across.sum"}},
    "rate": {"type": "Gain", "gain": {"value": 1e6, "unit": "V/s/A"}, "in": {"u": "current.y"}}, "capacitor": {"type": "Integrator", "in": {"u": "rate.y"}})",
      R"("stop": 0.006, "method": "dopri5", "relative_tolerance": 1e-10, "absolute_tolerance": 1e-12, "record_step": 0.0001)"));
  for (size_t i = 0; i < result.recording.rows(); ++i) {
    const double t = signal(result, "time")[i] - 0.001;
    EXPECT_NEAR(signal(result, "capacitor.y")[i], t <= 0 ? 0 : 5 * (1 - std::exp(-t / 0.001)), 1e-8) << t;
  }
}

TEST(Accuracy, AStepBetweenTicksIsNotSmeared) {
  // The integral of a unit step at an irrational time: exact, because the solver stops there.
  for (const char* method : {"dopri5", "cvode-bdf", "cvode-adams"}) {
    const RunResult result = run_of(diagram(
        R"("s": {"type": "Step", "time": 0.31830988618379067}, "x": {"type": "Integrator", "in": {"u": "s.y"}})",
        fmt::format(R"("stop": 1, "method": "{}", "record_step": 0.1)", method)));
    for (size_t i = 0; i < 11; ++i)
      EXPECT_NEAR(signal(result, "x.y")[i], std::max(0.0, 0.1 * double(i) - std::numbers::inv_pi), 1e-13)
          << method << " row " << i;
  }
}

TEST(Accuracy, AHeldInputIsDiscretisedExactly) {
  // dx/dt = -3 x + u, u held for 0.1 s: x[k+1] = e^-0.3 x[k] + (1 - e^-0.3)/3 u[k].
  for (const char* solver :
       {R"("stop": 2, "method": "dopri5", "relative_tolerance": 1e-11, "absolute_tolerance": 1e-13)",
        R"("stop": 2, "step": 0.001, "record_step": 0.1)"}) {
    const RunResult result =
        run_of(diagram(R"("n": {"type": "Noise", "sample_time": 0.1, "standard_deviation": 1},
      "x": {"type": "StrictlyProperTransferFunction", "numerator": [1], "denominator": [1, 3], "in": {"u": "n.y"}})",
                       solver));
    const auto &u = signal(result, "n.y"), &x = signal(result, "x.y");
    for (size_t k = 0; k + 1 < result.recording.rows(); ++k)
      EXPECT_NEAR(x[k + 1], std::exp(-0.3) * x[k] + (1 - std::exp(-0.3)) / 3 * u[k], 1e-10) << k;
  }
}

TEST(Accuracy, ASampledModelAgreesWithTheHeldContinuousOne) {
  const double a = std::exp(-0.3), b = (1 - a) / 3;
  const RunResult result = run_of(diagram(
      fmt::format(R"("n": {{"type": "Noise", "sample_time": 0.1, "standard_deviation": 1}},
    "x": {{"type": "StrictlyProperTransferFunction", "numerator": [1], "denominator": [1, 3], "in": {{"u": "n.y"}}}},
    "z": {{"type": "DiscreteStateSpace", "sample_time": 0.1, "A": [[{:.17g}]], "B": [[{:.17g}]], "C": [[1]], "D": [[0]], "in": {{"u": "n.y"}}}})",
                  a, b),
      R"("stop": 5, "method": "cvode-bdf", "relative_tolerance": 1e-9, "absolute_tolerance": 1e-11)"));
  const auto& z = result.recording.columns[3].values;
  for (size_t k = 0; k < result.recording.rows(); ++k) EXPECT_NEAR(signal(result, "x.y")[k], z[k], 1e-7) << k;
}

TEST(Accuracy, VanDerPolMeetsThePublishedValue) {
  // x'' = mu (1 - x²) x' - x with mu = 1000 scaled: y'' = ((1 - y²) y' - y) / 1e-6, y(0) = 2, y'(0) = 0, at t
  // = 2. Mazzia & Magherini, Test Set for IVP Solvers, 2008, problem VDPOL: y = 0.1706167732170483e1, y' =
  // -0.8928097010247975.
  const RunResult result = run_of(diagram(
      R"("y": {"type": "Integrator", "initial": 2, "in": {"u": "v.y"}}, "v": {"type": "Integrator", "in": {"u": "a.y"}},
    "a": {"type": "Expression", "formula": "((1-y*y)*v-y)/1e-6", "names": ["y", "v"], "in": {"arguments": ["y.y", "v.y"]}})",
      R"("stop": 2, "method": "cvode-bdf", "relative_tolerance": 1e-9, "absolute_tolerance": 1e-11, "record_step": 0.01)"));
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_NEAR(signal(result, "y.y").back(), 1.706167732170483, 1e-6);
  EXPECT_NEAR(signal(result, "v.y").back(), -0.8928097010247975, 1e-6);
}

TEST(Accuracy, RobertsonMeetsThePublishedValueAndKeepsItsMass) {
  // Hairer & Wanner, Solving ODEs II, section IV.10, at t = 40; CVODE's own example
  // prints 7.1583e-01, 9.1855e-06.
  const RunResult result = run_of(diagram(
      R"("a": {"type": "Integrator", "initial": 1, "in": {"u": "da.sum"}}, "b": {"type": "Integrator", "in": {"u": "db.sum"}}, "c": {"type": "Integrator", "in": {"u": "dc.y"}},
    "slow": {"type": "Gain", "gain": 0.04, "in": {"u": "a.y"}}, "bc": {"type": "Product", "in": {"factors": ["b.y", "c.y"]}}, "fast": {"type": "Gain", "gain": 1e4, "in": {"u": "bc.product"}},
    "bb": {"type": "Product", "in": {"factors": ["b.y", "b.y"]}}, "dc": {"type": "Gain", "gain": 3e7, "in": {"u": "bb.product"}},
    "da": {"type": "Sum", "signs": "-+", "in": {"terms": ["slow.y", "fast.y"]}}, "db": {"type": "Sum", "signs": "+--", "in": {"terms": ["slow.y", "fast.y", "dc.y"]}})",
      R"("stop": 40, "method": "cvode-bdf", "relative_tolerance": 1e-8, "absolute_tolerance": 1e-13, "record_step": 0.4)"));
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_NEAR(signal(result, "a.y").back(), 0.7158270688, 1e-6);
  EXPECT_NEAR(signal(result, "b.y").back(), 9.185534765e-6, 1e-10);
  for (size_t i = 0; i < result.recording.rows(); ++i)
    EXPECT_NEAR(signal(result, "a.y")[i] + signal(result, "b.y")[i] + signal(result, "c.y")[i], 1, 1e-9);
}

/// x' = -x(t - 1) with x = 1 before 0, by the method of steps: sum of (-1)^k (t - k + 1)^k / k! up to k = t
/// + 1.
double delayed_decay(double t) {
  double sum = 0, factorial = 1;
  for (int k = 0; k <= int(t) + 1; factorial *= ++k)
    sum += (k % 2 ? -1 : 1) * std::pow(t - k + 1, k) / factorial;
  return sum;
}

TEST(Accuracy, ADelayInALoopMeetsTheMethodOfStepsTheCloserTheTolerance) {
  for (const char* method : {"dopri5", "cvode-bdf", "cvode-adams"}) {
    double before = 1;
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
      const RunResult result = run_of(diagram(
          R"("x": {"type": "Integrator", "initial": 1, "in": {"u": "n.y"}}, "n": {"type": "Gain", "gain": -1, "in": {"u": "d.y"}},
      "d": {"type": "TransportDelay", "delay": 1, "initial": 1, "points": 20000, "in": {"u": "x.y"}})",
          fmt::format(
              R"("stop": 6, "method": "{}", "relative_tolerance": {}, "absolute_tolerance": {}, "record_step": 0.5)",
              method, tolerance, tolerance)));
      ASSERT_EQ(result.status, RunStatus::finished) << method << result.message;
      double worst = 0;
      for (size_t k = 0; k < result.recording.rows(); ++k)
        worst =
            std::max(worst, std::abs(signal(result, "x.y")[k] - delayed_decay(signal(result, "time")[k])));
      EXPECT_LT(worst, 20 * tolerance) << method;
      EXPECT_LT(worst, before / 10) << method << ' ' << tolerance;
      before = worst;
    }
  }
}

RunResult run_file(const std::string& path) {
  return simulate(*load_plan(fmt::format("{}/diagrams/{}", LOOPWRIGHT_SOURCE, path)));
}
double peak(const RunResult& result, std::string_view name) {
  double worst = 0;
  for (double v : signal(result, name)) worst = std::max(worst, std::abs(v));
  return worst;
}

TEST(Accuracy, TheCommonJobEndsWhereTwoOtherProgramsEnded) {
  const RunResult sampled = run_file("linear_motor/common_job.json");
  ASSERT_EQ(sampled.status, RunStatus::finished) << sampled.message;
  EXPECT_NEAR(signal(sampled, "stage.position").back(), 0.5999966, 1e-7);
  EXPECT_NEAR(peak(sampled, "error.sum") * 1e6, 823.02, 0.05);
}

TEST(Accuracy, TheContinuousCommonJobEndsWhereTwoOtherProgramsEnded) {
  const RunResult continuous = run_file("linear_motor/common_job_continuous.json");
  ASSERT_EQ(continuous.status, RunStatus::finished) << continuous.message;
  EXPECT_NEAR(signal(continuous, "stage.position").back(), 0.5999968135, 2e-9);
  EXPECT_NEAR(peak(continuous, "error.sum") * 1e6, 760, 0.5);
}

}  // namespace
}  // namespace loopwright::accuracy_test
