#include <gmock/gmock.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::pwm_test {
namespace {

constexpr double frequency = 1000, dead_time = 20e-6;

std::string settings(const std::string& more) {
  return R"({"bus": 48, "frequency": 1000, "dead_time": 2e-5)" + more + "}";
}

/// The mean over ten periods, after one to begin with.
double mean_voltage(BlockUnderTest& pwm, double command, double current) {
  pwm.input("command") = command, pwm.input("current") = current;
  constexpr int points = 20000;  // a period
  double sum = 0;
  for (int k = 0; k < 11 * points; ++k) {
    pwm.evaluate((k + 0.5) / points / frequency, k);
    EXPECT_EQ(std::abs(pwm.output("voltage")), 24);
    if (k >= points) sum += pwm.output("voltage");
  }
  return sum / (10 * points);
}

TEST(Pwm, TheMeanIsTheCommandLessTheErrorOfTheDeadTime) {
  for (const double command : {-20.0, 0.0, 3.0, 12.0})
    for (const double current : {-5.0, 0.0, 5.0}) {
      BlockUnderTest pwm("Pwm", settings(""));
      const double sign = current > 0 ? 1 : current < 0 ? -1 : 0;
      EXPECT_NEAR(mean_voltage(pwm, command, current), command - sign * 48 * dead_time * frequency, 0.01)
          << command << ' ' << current;
    }
}

TEST(Pwm, TheAveragedOneHasTheSameMean) {
  BlockUnderTest pwm("Pwm", settings(R"(, "kind": "averaged", "current_width": 0.1)"));
  pwm.input("command") = 3;
  for (const double current : {-5.0, 0.0, 5.0}) {
    pwm.input("current") = current;
    pwm.evaluate();
    EXPECT_NEAR(pwm.output("voltage"), 3 - 48 * dead_time * frequency * std::tanh(current / 0.1), 1e-12);
  }
  pwm.input("command") = 100, pwm.input("current") = 0;
  pwm.evaluate();
  EXPECT_EQ(pwm.output("voltage"), 24);
}

TEST(Pwm, IsAtARailBeyondIt) {
  BlockUnderTest pwm("Pwm", settings(""));
  EXPECT_NEAR(mean_voltage(pwm, 30, 5), 24, 1e-12);
  BlockUnderTest low("Pwm", settings(""));
  EXPECT_NEAR(mean_voltage(low, -30, 5), -24, 1e-12);
}

TEST(Pwm, ThePulseIsInTheMiddleOfTheCarrierAndTheDeadTimeDelaysItsRise) {
  // A command of 0 with the carrier -1 at t = 0: high in the first and last quarter of a period.
  BlockUnderTest pwm("Pwm", settings(""));
  pwm.input("current") = 5;
  const auto at = [&](double microseconds) {
    pwm.evaluate(microseconds * 1e-6, 0);
    return pwm.output("voltage");
  };
  EXPECT_EQ(at(1), 24);
  EXPECT_EQ(at(249), 24);
  EXPECT_EQ(at(251), -24) << "the lower diode takes over at once";
  EXPECT_EQ(at(600), -24);
  EXPECT_EQ(at(751), -24) << "the lower diode still conducts";
  EXPECT_EQ(at(770.5), -24);
  EXPECT_EQ(at(771.5), 24);
}

TEST(Pwm, RefusesWhatCannotWork) {
  const auto text = [](const char* more) {
    return BlockUnderTest("Pwm", std::string(R"({"bus": 48, "frequency": 1000)") + more + "}")
        .problems()
        .text();
  };
  EXPECT_THAT(text(R"(, "dead_time": 6e-4)"), testing::HasSubstr("half a period"));
  EXPECT_THAT(text(R"(, "dead_time": 1e-6, "kind": "averaged")"), testing::HasSubstr("within its ripple"));
}

}  // namespace
}  // namespace loopwright::pwm_test
