#include <gmock/gmock.h>
#include <functional>
#include "tests/blocks/frequency_response.h"

namespace loopwright::disturbance_observer_test {
namespace {

constexpr double T = 0.001, mass = 0.2621;

std::string settings(double damping, int degree, const char* path) {
  return R"({"mass": 0.2621, "cutoff": 250, "damping": )" + std::to_string(damping) +
         R"(, "relative_degree": )" + std::to_string(degree) + R"(, "command_path": ")" + path + R"("})";
}
Complex q(Complex s, int degree) { return std::pow(250.0 / (s + 250.0), degree); }

/// The nominal mass behind a zero-order hold, solved exactly from sample to sample.
struct Plant {
  double damping, x = 0, v = 0.05;
  void step(double force) {
    if (damping == 0) {
      x += T * v + T * T / 2 * force / mass, v += T * force / mass;
      return;
    }
    const double end = force / damping, decay = std::exp(-damping * T / mass);
    x += end * T + (v - end) * mass / damping * (1 - decay);
    v = end + (v - end) * decay;
  }
};

/// Holds the mass with a PD controller. The observer and a compensation are connected as the observer's
/// reference page describes. Returns the estimate at the end.
double estimate_after(const std::string& observer_settings, double damping, int samples,
                      std::function<double(int)> disturbance, std::function<double(int)> compensation,
                      double limit = infinity) {
  BlockUnderTest observer("DisturbanceObserver", observer_settings, T);
  BlockUnderTest feedback("PdController", R"({"Kp": 400, "Kd": 20, "derivative_pole": 1000})", T);
  Plant plant{damping};  // moves at the start, but the observer assumes rest: it must converge
  double estimate = 0;
  for (int k = 0; k < samples; ++k) {
    observer.input("measured") = plant.x;
    observer.evaluate(k * T, k);
    estimate = observer.output("disturbance");
    const double wanted = feedback.sample("measured", plant.x, "command") - estimate - compensation(k);
    const double sent = std::clamp(wanted, -limit, limit);
    observer.input("command") = sent + compensation(k);
    observer.update();
    plant.step(sent + disturbance(k));
  }
  return estimate;
}
double none(int) { return 0; }

TEST(DisturbanceObserver, TheMeasurementPassesQOverThePlant) {
  for (int n : {2, 3}) {
    BlockUnderTest block("DisturbanceObserver", settings(3, n, "matched"), T);
    for (double w : {0.0, 20.0, 300.0, 2000.0}) {
      const Complex s = tustin(w, T);
      EXPECT_COMPLEX_NEAR(sampled_response(block, "measured", "disturbance", w, T, 2000),
                          q(s, n) * (mass * s * s + 3.0 * s), 1e-7);
    }
  }
}

TEST(DisturbanceObserver, TheCommandPassesQInStepWithAZeroOrderHoldOrOneSampleLate) {
  for (int n : {2, 3}) {
    BlockUnderTest matched("DisturbanceObserver", settings(3, n, "matched"), T),
        delayed("DisturbanceObserver", settings(3, n, "delayed"), T);
    for (double w : {0.0, 20.0, 300.0, 2000.0}) {
      const Complex s = tustin(w, T), z = std::polar(1.0, w * T);
      EXPECT_COMPLEX_NEAR(sampled_response(matched, "command", "disturbance", w, T, 2000),
                          -q(s, n) * 2.0 / (z + 1.0), 1e-12);
      EXPECT_COMPLEX_NEAR(sampled_response(delayed, "command", "disturbance", w, T, 2000), -q(s, n) / z,
                          1e-12);
    }
  }
}

TEST(DisturbanceObserver, DelayedIsTheRecursionOfTheExpandedPolynomials) {
  BlockUnderTest block("DisturbanceObserver", settings(3, 2, "delayed"), T);
  const double k = 2 / T, w2 = 250.0 * 250, scale = k * k + 2 * 250 * k + w2;
  const double a1 = (2 * w2 - 2 * k * k) / scale, a2 = (k * k - 2 * 250 * k + w2) / scale;
  const double n2 = w2 * mass * k * k, n1 = w2 * 3 * k;
  double x1 = 0, x2 = 0, p1 = 0, p2 = 0, u1 = 0, u2 = 0, u3 = 0, c1 = 0, c2 = 0;
  for (int i = 0; i < 300; ++i) {
    const double x = 1e-3 * std::sin(0.03 * i), u = std::cos(0.1 * i * i);
    const double p = ((n2 + n1) * x - 2 * n2 * x1 + (n2 - n1) * x2) / scale - a1 * p1 - a2 * p2;
    const double c = w2 * (u1 + 2 * u2 + u3) / scale - a1 * c1 - a2 * c2;
    block.input("command") = u;
    EXPECT_NEAR(block.sample("measured", x, "disturbance"), p - c, 1e-9) << i;
    x2 = x1, x1 = x, p2 = p1, p1 = p, u3 = u2, u2 = u1, u1 = u, c2 = c1, c1 = c;
  }
}

TEST(DisturbanceObserver, MatchedSeesNoDisturbanceInAMassThatHasNone) {
  for (int n : {2, 3}) {
    BlockUnderTest block("DisturbanceObserver", settings(0, n, "matched"), T);
    Plant plant{0, 0, 0};
    double worst = 0;
    for (int k = 0; k < 2000; ++k) {
      const double u = std::sin(0.01 * k * k) + (k > 700 ? 1 : -1);
      block.input("command") = u;
      worst = std::max(worst, std::abs(block.sample("measured", plant.x, "disturbance")));
      plant.step(u);
    }
    EXPECT_LT(worst, 1e-9);
    EXPECT_GT(std::abs(plant.x), 0.1);
  }
}

TEST(DisturbanceObserver, FindsAConstantDisturbanceExactly) {
  for (int n : {2, 3})
    for (const char* path : {"matched", "delayed"})
      EXPECT_NEAR(estimate_after(
                      settings(3, n, path), 3, 6000, [](int) { return 0.7; }, none),
                  0.7, 1e-9)
          << path << n;
}

TEST(DisturbanceObserver, LeavesAPerfectCompensationItsWork) {
  const auto disturbance = [](int k) { return 0.7 + 0.5 * std::sin(0.05 * k); };
  EXPECT_NEAR(estimate_after(settings(0, 2, "matched"), 0, 3000, disturbance, disturbance), 0, 1e-9);
  EXPECT_NEAR(estimate_after(settings(3, 2, "matched"), 3, 3000, disturbance, disturbance), 0, 1e-9);
  EXPECT_NEAR(estimate_after(settings(3, 3, "delayed"), 3, 3000, disturbance, disturbance), 0, 1e-9);
}

TEST(DisturbanceObserver, DoesNotTakeTheLimitOfTheCommandForADisturbance) {
  const auto strong = [](int) { return 0.7; };
  EXPECT_NEAR(estimate_after(settings(3, 2, "matched"), 3, 3000, strong, none, 0.5), 0.7, 1e-6);
}

TEST(DisturbanceObserver, IsFedByTheMeasurementAlone) {
  for (const char* type : {"DisturbanceObserver", "ContinuousDisturbanceObserver"}) {
    BlockUnderTest block(type, R"({"mass": 1, "damping": 0, "cutoff": 10})", type[0] == 'D' ? T : 0);
    EXPECT_EQ(block.info().inputs[0].name, "measured");
    EXPECT_EQ(block.info().outputs[0].fed_by, 1u);
    block.input("measured") = 0.001;
    block.evaluate();  // the command reads NaN in this call
    EXPECT_TRUE(std::isfinite(block.output("disturbance")));
  }
}

TEST(DisturbanceObserver, AtRestAtItsInitialPositionGivesNothing) {
  BlockUnderTest block("DisturbanceObserver", R"({"mass": 1, "damping": 3, "cutoff": 250, "initial": 0.3})",
                       T);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(block.sample("measured", 0.3, "disturbance"), 0);
}

TEST(ContinuousDisturbanceObserver, AnswersEveryFrequencyAsItsFormulaSays) {
  for (int n : {2, 3}) {
    BlockUnderTest block(
        "ContinuousDisturbanceObserver",
        R"({"mass": 0.2621, "damping": 3, "cutoff": 250, "relative_degree": )" + std::to_string(n) + "}");
    for (double w : {0.0, 20.0, 300.0, 1e4}) {
      const Complex s(0, w);
      block.input("command") = 0;
      EXPECT_COMPLEX_NEAR(continuous_response(block, "measured", "disturbance", w),
                          q(s, n) * (mass * s * s + 3.0 * s), 1e-8);
      block.input("measured") = 0;
      EXPECT_COMPLEX_NEAR(continuous_response(block, "command", "disturbance", w), -q(s, n), 1e-12);
    }
  }
}

}  // namespace
}  // namespace loopwright::disturbance_observer_test
