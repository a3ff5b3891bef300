#include <gmock/gmock.h>
#include "tests/blocks/frequency_response.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::continuous_pid_controller_test {
namespace {

const char* const gains = R"({"Kp": 3, "Ki": 7, "Kd": 0.4, "derivative_pole": 60, "b": 0.5, "c": 0.2})";

TEST(ContinuousPidController, HasItsTransferFunction) {
  for (double w : {0.5, 5.0, 100.0, 1000.0}) {
    BlockUnderTest block("ContinuousPidController", gains);
    const Complex s(0, w), slope = 60.0 * s / (s + 60.0);
    EXPECT_COMPLEX_NEAR(continuous_response(block, "reference", "command", w),
                        3 * 0.5 + 7.0 / s + 0.4 * 0.2 * slope, 1e-11);
    block.input("reference") = 0;
    EXPECT_COMPLEX_NEAR(continuous_response(block, "measured", "command", w), -3.0 - 7.0 / s - 0.4 * slope,
                        1e-11);
  }
}

TEST(ContinuousPidController, IsTheLimitOfTheSampledOne) {
  // The same loop around a plant of second order, with limits that it meets.
  const auto loop = [](const char* controller, const char* more) {
    const RunResult result =
        run_of(diagram(fmt::format(R"("r": {{"type": "Step", "time": 0.1}},
          "pid": {{"type": "{}", "Kp": 4, "Ki": 6, "Kd": 0.2, "derivative_pole": 50, "low": -1.2, "high": 1.2,
                  "anti_windup": "back_calculation", "tracking_gain": 1.5{}, "in": {{"reference": "r.y", "measured": "plant.y"}}}},
          "plant": {{"type": "StrictlyProperTransferFunction", "numerator": [1], "denominator": [0.3, 1.3, 1], "in": {{"u": "pid.command"}}}})",
                                   controller, more),
                       R"("method": "dopri5", "stop": 5, "record_step": 0.05, "relative_tolerance": 1e-9)"));
    EXPECT_EQ(result.message, "");
    return signal(result, "plant.y");
  };
  const auto continuous = loop("ContinuousPidController", ""),
             coarse = loop("PidController", R"(, "sample_time": 0.002)"),
             fine = loop("PidController", R"(, "sample_time": 0.0005)");
  double coarse_error = 0, fine_error = 0;
  for (size_t i = 0; i < continuous.size(); ++i) {
    coarse_error = std::max(coarse_error, std::fabs(coarse[i] - continuous[i]));
    fine_error = std::max(fine_error, std::fabs(fine[i] - continuous[i]));
  }
  EXPECT_LT(fine_error, 2e-3);
  EXPECT_NEAR(coarse_error / fine_error, 4, 0.6) << "an error in proportion to the sample time";
}

TEST(ContinuousPidController, TheDerivativeStartsAtRest) {
  // 25 degC in a room at 20 degC: no kick, although the temperatures are some 300 K above zero.
  const RunResult result = run_of(diagram(
      R"("r": {"type": "Constant", "value": {"value": 25, "unit": "degC"}}, "y": {"type": "Constant", "value": {"value": 20, "unit": "degC"}},
         "pid": {"type": "ContinuousPidController", "Kp": {"value": 2, "unit": "W/K"}, "Ki": 0, "Kd": {"value": 50, "unit": "W*s/K"},
                 "derivative_pole": 10, "in": {"reference": "r.y", "measured": "y.y"}})",
      R"("method": "dopri5", "stop": 1, "record_step": 0.1)"));
  for (const double command : signal(result, "pid.command")) EXPECT_NEAR(command, 10, 1e-9);
}

TEST(ContinuousPidController, RefusesWhatCannotWork) {
  EXPECT_THAT(BlockUnderTest("ContinuousPidController",
                             R"({"Kp": 1, "Ki": 1, "Kd": 1, "derivative_pole": 9, "low": 1, "high": 1})")
                  .problems()
                  .text(),
              testing::HasSubstr("low < high"));
}

}  // namespace
}  // namespace loopwright::continuous_pid_controller_test
