#include <gmock/gmock.h>
#include "tests/blocks/frequency_response.h"

namespace loopwright::pd_controller_test {
namespace {

constexpr auto settings = R"({"Kp": 2000, "Kd": 30, "derivative_pole": 1000})";
constexpr double T = 0.001;
Complex formula(Complex s) { return 2000.0 + 30.0 * 1000.0 * s / (s + 1000.0); }

TEST(PdController, IsTheTustinImageOfItsFormula) {
  BlockUnderTest block("PdController", settings, T);
  for (double w : {0.0, 10.0, 500.0, 2500.0}) {
    EXPECT_COMPLEX_NEAR(sampled_response(block, "reference", "command", w, T, 500), formula(tustin(w, T)),
                        1e-8);
    EXPECT_COMPLEX_NEAR(sampled_response(block, "measured", "command", w, T, 500), -formula(tustin(w, T)),
                        1e-8);
  }
}

TEST(PdController, FollowsTheRecursionOfTheCommonJob) {
  BlockUnderTest block("PdController", settings, T);
  const double k = 2 / T, keep = (k - 1000) / (k + 1000), slope = 1000 * k / (k + 1000);
  double last = 0, derivative = 0;
  for (int i = 0; i < 200; ++i) {
    const double reference = 1e-3 * i, measured = 1e-3 * std::sin(0.1 * i), error = reference - measured;
    derivative = keep * derivative + slope * (error - last);
    last = error;
    block.input("reference") = reference;
    EXPECT_NEAR(block.sample("measured", measured, "command"), 2000 * error + 30 * derivative, 1e-10);
  }
}

TEST(PdController, OnTheMeasurementIgnoresJumpsOfTheReferenceInTheDerivative) {
  BlockUnderTest block("PdController",
                       R"({"Kp": 2, "Kd": 30, "derivative_pole": 1000, "derivative_of": "measurement"})", T);
  EXPECT_EQ(block.sample("reference", 5, "command"), 10);
  EXPECT_EQ(block.sample("reference", -5, "command"), -10);
  block.restart();
  block.input("reference") = 0;
  for (double w : {0.0, 700.0}) {
    const Complex s = tustin(w, T);
    EXPECT_COMPLEX_NEAR(sampled_response(block, "measured", "command", w, T, 500),
                        -2.0 - 30.0 * 1000.0 * s / (s + 1000.0), 1e-8);
  }
}

TEST(PdController, AtRestGivesTheProportionalPartExactly) {
  BlockUnderTest block("PdController", R"({"Kp": 2000, "Kd": 30, "derivative_pole": 1000, "initial": 0.25})",
                       T);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(block.sample("reference", 0.25, "command"), 500);
}

TEST(ContinuousPdController, AnswersEveryFrequencyAsItsFormulaSays) {
  BlockUnderTest block("ContinuousPdController", settings);
  for (double w : {0.0, 10.0, 500.0, 1e5}) {
    EXPECT_COMPLEX_NEAR(continuous_response(block, "reference", "command", w), formula({0, w}), 1e-9);
    block.input("reference") = 0;
    EXPECT_COMPLEX_NEAR(continuous_response(block, "measured", "command", w), -formula({0, w}), 1e-9);
    block.input("measured") = 0;
  }
}

}  // namespace
}  // namespace loopwright::pd_controller_test
