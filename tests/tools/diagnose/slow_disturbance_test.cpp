// Disturbances that are alike for many rows: noise while they are small, and never an effect.
#include <gmock/gmock.h>
#include <cmath>
#include "tests/judgement.h"
#include "tests/tools/diagnose/diagnosed_plant.h"

namespace loopwright::slow_disturbance_test {
namespace {

using testing::AnyOf, testing::Contains, testing::ElementsAre, testing::HasSubstr, testing::IsEmpty,
    testing::Not;

/// Terms and moved parameters.
std::vector<std::string> answer(const Diagnosis& d) {
  std::vector<std::string> list = terms(d);
  for (const MovedParameter& p : d.moved_parameters) list.push_back(p.name);
  return list;
}

/// [N m] rms of the torques of the motor.
constexpr double torque_rms = 0.044;
/// [W] rms of the heat that enters the first body of two.
constexpr double heat_rms = 55;

/// A motor whose rotor is also driven by a torque that wanders.
Plant disturbed_motor(const Motor& m, double share, uint64_t seed) {
  Plant plant = motor(m, seed);
  plant.slow_noise = {0, share * torque_rms}, plant.rows = 1200;
  return plant;
}

TEST(SlowDisturbance, ACleanMotorBesideItLacksNothing) {
  const Diagnosis d = diagnosed(disturbed_motor({}, 0.02, 21));
  EXPECT_EQ(d.verdict, Verdict::nothing_missing) << to_text(d);
  EXPECT_THAT(answer(d), IsEmpty());
  EXPECT_THAT(findings(d), Contains(HasSubstr("it is taken for noise"))) << to_text(d);
  EXPECT_LT(d.portmanteau, 120);
}

TEST(SlowDisturbance, DryFrictionBesideItIsNamedWithItsSize) {
  IS_A_JUDGEMENT();
  Motor m;
  m.torque = [](double speed, double) { return 0.01 * std::tanh(speed / 0.5); };
  const Diagnosis d = diagnosed(disturbed_motor(m, 0.02, 22));
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  ASSERT_THAT(answer(d), ElementsAre("torques.sum: sign(rotor.velocity)")) << to_text(d);
  expect_parameter(d.effects[0], "level", -0.01, 0.001, "N*m");
  EXPECT_THAT(findings(d), Contains(HasSubstr("a slow disturbance at torque")));
}

/// An effect as small as a disturbance may be is an effect if it follows a law.
TEST(SlowDisturbance, ASmallEffectIsNotTakenForOne) {
  Motor m;
  m.torque = [](double speed, double) { return 0.02 * torque_rms * std::tanh(speed / 0.5); };
  const Diagnosis d = diagnosed(disturbed_motor(m, 0, 23));
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  EXPECT_THAT(answer(d), ElementsAre("torques.sum: sign(rotor.velocity)")) << to_text(d);
  EXPECT_THAT(findings(d), Not(Contains(HasSubstr("a slow disturbance"))));
}

/// A disturbed motor whose resistance is a multiple of what its diagram states.
Diagnosis diagnosed_with_resistance(double multiple) {
  Motor m;
  m.resistance *= multiple;
  return diagnosed(disturbed_motor(m, 0.02, 25));
}

/// An effect without a name bends the parameters that resemble it, and a disturbance follows what is left.
TEST(SlowDisturbance, ParametersThatAreHardlyOffBesideItDoNotExplainEverything) {
  const Diagnosis d = diagnosed_with_resistance(1.01);
  EXPECT_EQ(d.verdict, Verdict::partly_explained) << to_text(d);
  EXPECT_THAT(answer(d), ElementsAre("resistance"));
  EXPECT_THAT(findings(d), Contains(HasSubstr("both may stand for an effect")));
}

TEST(SlowDisturbance, AParameterThatIsClearlyOffBesideItExplainsEverything) {
  const Diagnosis d = diagnosed_with_resistance(1.1);
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  EXPECT_THAT(answer(d), ElementsAre("resistance"));
}

/// So much may be what nobody has modelled.
TEST(SlowDisturbance, ALargeOneIsNotCalledNoise) {
  Plant plant = thermal({}, 24);
  plant.slow_noise = {0.15 * heat_rms, 0}, plant.rows = 1200;
  const Diagnosis d = diagnosed(plant);
  EXPECT_THAT(d.verdict, AnyOf(Verdict::unexplained, Verdict::partly_explained)) << to_text(d);
}

}  // namespace
}  // namespace loopwright::slow_disturbance_test
