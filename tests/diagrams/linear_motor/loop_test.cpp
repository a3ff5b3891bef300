// The parts that all loops of diagrams/linear_motor share.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <set>
#include "engine/plan/plan.h"
#include "tools/studies/linear_motor/runs.h"
#include "where.h"

namespace loopwright::paper::loop_test {
namespace {

const std::string folder = LOOPWRIGHT_SOURCE "/diagrams/linear_motor/";

/// Mean of a column from a given time.
double mean_after(const Recording& recording, std::string_view name, double from_s) {
  const auto time = column(recording, "time"), values = column(recording, name);
  double sum = 0, count = 0;
  for (size_t i = 0; i < time.size(); ++i)
    if (time[i] >= from_s) sum += values[i], ++count;
  return sum / count;
}

Recording motion(const char* name) { return run_diagram(folder + "motions/" + name + ".json", {}, 0); }

TEST(LinearMotor, ConventionalTracksAsItWasCalibratedTo) {
  const Recording run = run_diagram(folder + "conventional.json", {}, 0);
  EXPECT_NEAR(1e6 * tracking_rmse(run), 42.048, 0.03 * 42.048);
}

TEST(LinearMotor, WhatTheCompensationCancelsTheObserverDoesNotSee) {
  // A stage that matches the controller's nominal model, pulled back by half a newton, at one newton a volt.
  LoadOptions pulled{.set = {{"stage.motor.cogging", "0"},
                             {"stage.motor.second_cogging", "0"},
                             {"stage.motor.drag", "0"},
                             {"stage.motor.damping", "3"},
                             {"stage.motor.offset", "0.5"}}};
  const Recording alone = run_diagram(folder + "conventional.json", pulled, 0);
  EXPECT_NEAR(mean_after(alone, "controller.disturbance", 0.3), -0.5, 0.01);
  pulled.set.emplace_back("compensation.value", "-0.5");
  const Recording compensated = run_diagram(folder + "conventional.json", pulled, 0);
  EXPECT_NEAR(mean_after(compensated, "controller.disturbance", 0.3), 0, 0.01);
  EXPECT_NEAR(mean_after(compensated, "controller.command", 0.3),
              mean_after(alone, "controller.command", 0.3), 0.01)
      << "both cancel it, once";
}

TEST(LinearMotor, ALatencyThatTheObserverDoesNotKnowChangesTheLoop) {
  const LoadOptions late{.variants = {{"stage.latency", "one_sample"}}},
      known{.variants = {{"stage.latency", "one_sample"}, {"controller.latency", "one_sample"}}};
  const double unknown_rmse = tracking_rmse(run_diagram(folder + "conventional.json", late, 0)),
               known_rmse = tracking_rmse(run_diagram(folder + "conventional.json", known, 0)),
               plain = tracking_rmse(run_diagram(folder + "conventional.json", {}, 0));
  EXPECT_GT(known_rmse, 1.05 * plain) << "a later loop tracks worse";
  EXPECT_GT(std::abs(known_rmse - unknown_rmse), 1e-6);
}

TEST(LinearMotor, AHomingErrorMovesTheMagnetsNotTheReading) {
  const Recording run = run_diagram(folder + "conventional.json", {.set = {{"homing_error", "1 mm"}}}, 0);
  EXPECT_NEAR(column(run, "stage.position")[0], 0, 1e-6);
  const Recording plain = run_diagram(folder + "conventional.json", {}, 0);
  EXPECT_GT(
      std::abs(mean_after(run, "controller.disturbance", 0) - mean_after(plain, "controller.disturbance", 0)),
      1e-4);
}

TEST(LinearMotor, ThePapersMotionIsAsItsTextSays) {
  const Recording run = motion("paper");
  const auto position = column(run, "motion.position"), velocity = column(run, "motion.velocity");
  EXPECT_NEAR(position.back(), 0.6, 1e-12);
  EXPECT_NEAR(*std::ranges::max_element(velocity), 0.35, 1e-12);
  EXPECT_EQ(velocity[size_t(1000 * (motion_start_s + 0.7))], 0.15);
  EXPECT_EQ(velocity[size_t(1000 * (motion_start_s + 2.0))], 0.35);
  EXPECT_NEAR(velocity.back(), 0, 1e-12);
}

/// Velocities [mm/s] held for 20 mm or more.
std::set<int> velocities_held(const Recording& run) {
  const auto velocity = column(run, "motion.velocity");
  std::set<int> held;
  double stretch = 0;
  for (size_t i = 1; i < velocity.size(); ++i) {
    stretch = velocity[i] == velocity[i - 1] ? stretch + 0.001 * std::abs(velocity[i]) : 0;
    if (stretch > 0.02) held.insert(int(std::lround(1000 * velocity[i])));
  }
  return held;
}

TEST(LinearMotor, IdentificationHoldsTenVelocitiesOverSevenHundredMillimetres) {
  const Recording run = motion("identification");
  EXPECT_EQ(velocities_held(run), (std::set<int>{-400, 50, 100, 150, 200, 250, 300, 350, 400, 450, 500}));
  EXPECT_NEAR(*std::ranges::max_element(column(run, "motion.position")), 0.7, 1e-9);
  EXPECT_NEAR(column(run, "motion.position").back(), 0, 1e-9);
}

TEST(LinearMotor, TheHeldOutMotionSharesNoVelocityWithTrainingOrTest) {
  const std::set<int> held_out = velocities_held(motion("held_out"));
  EXPECT_EQ(held_out.size(), 4u);
  for (const char* other : {"identification", "paper"})
    for (const int velocity : velocities_held(motion(other)))
      EXPECT_FALSE(held_out.contains(velocity)) << velocity << " mm/s in " << other;
}

}  // namespace
}  // namespace loopwright::paper::loop_test
