// The diagnosis of axes that were built and measured.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include "tools/diagnose/diagnose.h"
#include "where.h"

namespace loopwright::measured_axes_test {
namespace {

using testing::AnyOf, testing::Contains;

bool has_data(const std::string& file) {
  setenv("LOOPWRIGHT_DATA", LOOPWRIGHT_SOURCE "/../shared/data", 0);
  return std::filesystem::exists(std::string(std::getenv("LOOPWRIGHT_DATA")) + "/" + file);
}

Diagnosis diagnosed(const std::string& axis, const std::string& experiment) {
  const std::string folder = LOOPWRIGHT_SOURCE "/diagrams/" + axis;
  return diagnose(folder + "/nominal.json", {folder + "/" + experiment + ".experiment.json"});
}

TEST(MeasuredAxes, EmpsLacksCoulombFrictionAndThenFrictionThatDiffersWithTheDirection) {
  if (!has_data("emps/emps_train.csv")) GTEST_SKIP() << "no emps/emps_train.csv below $LOOPWRIGHT_DATA";
  const Diagnosis d = diagnosed("emps", "open_loop");
  ASSERT_GE(d.steps.size(), 3u);
  EXPECT_THAT(d.steps[1].added,
              Contains(AnyOf("coulomb_friction", "presliding_hysteresis", "smooth_friction")));
  EXPECT_THAT(d.steps[2].added, Contains("direction_dependent_friction"));
  EXPECT_GT(d.steps[0].held_out_force_rmse, 9) << "N";
  EXPECT_LT(d.steps[1].held_out_force_rmse, 4.2);
  EXPECT_LE(d.steps[2].held_out_force_rmse, 1.4) << "two effects";
  for (size_t i = 0; i < d.steps.size(); ++i) EXPECT_EQ(d.steps[i].is_optional, i > 2) << i;
}

TEST(MeasuredAxes, ABrushlessMotorCogs72TimesARevolution) {
  if (!has_data("bldc_cogging_laas/speed_test1_2pi_rad_s.csv"))
    GTEST_SKIP() << "no bldc_cogging_laas/speed_test1_2pi_rad_s.csv below $LOOPWRIGHT_DATA";
  const Diagnosis d = diagnosed("bldc", "speed");
  const auto found = std::ranges::find(d.effects, "cogging", &DiagnosedEffect::name);
  ASSERT_NE(found, d.effects.end());
  const auto pitch = std::ranges::find(found->parameters, "pitch", &DiagnosedParameter::name);
  ASSERT_NE(pitch, found->parameters.end());
  EXPECT_NEAR(2 * std::numbers::pi / pitch->value, 72, 0.05) << "the strongest of all cogging";
  EXPECT_EQ(d.verdict, Verdict::partly_explained) << "one direction does not show what its friction is";
  EXPECT_LT(d.error_after, d.error_before / 3) << "held out";
}

TEST(MeasuredAxes, TheSameMotorHeldStepByStepCogs72TimesAndHasDryFriction) {
  if (!has_data("bldc_cogging_laas/holding_current_map.csv"))
    GTEST_SKIP() << "no bldc_cogging_laas/holding_current_map.csv below $LOOPWRIGHT_DATA";
  const Diagnosis d = diagnosed("bldc", "map");
  ASSERT_GE(d.effects.size(), 2u);
  EXPECT_EQ(d.effects[0].name, "cogging");
  EXPECT_EQ(d.effects[1].name, "coulomb_friction");
  const auto pitch = std::ranges::find(d.effects[0].parameters, "pitch", &DiagnosedParameter::name);
  EXPECT_NEAR(2 * std::numbers::pi / pitch->value, 72, 0.1);
  EXPECT_GT(d.error_before / d.error_after, 5) << "held out";
}

}  // namespace
}  // namespace loopwright::measured_axes_test
