// Homing against a switch, in simulation and on the emulated card.
#include <gmock/gmock.h>
#include <algorithm>
#include <cmath>
#include <span>
#include "hw/realtime/deploy.h"
#include "tests/hw/deployment.h"

namespace loopwright::homing_test {
namespace {

const std::string diagram = LOOPWRIGHT_SOURCE "/diagrams/tutorial/homing.json";
enum State { off, working, search, turn, leave, homed, move, arrived, fault };
constexpr double goal = 0.08;  // m from the place of the switch

using hw::column;

/// The states in their order, without repetitions.
std::vector<int> states_of(const Recording& recording) {
  std::vector<int> states;
  for (const double state : column(recording, "machine.state"))
    if (states.empty() || states.back() != int(state)) states.push_back(int(state));
  return states;
}
size_t first_row_of(const Recording& recording, State state) {
  const auto& states = column(recording, "machine.state");
  return size_t(std::ranges::find(states, double(state)) - states.begin());
}

/// The new zero is where the switch opens, to the distance that the axis moves in a sample, and a count.
constexpr double zero_error = 2.5e-6;  // m

/// `place`: of the switch, as the encoder counts.
void expect_homed_and_moved(const Recording& recording, double place) {
  EXPECT_EQ(states_of(recording), (std::vector<int>{off, search, turn, leave, homed, move, arrived}));
  EXPECT_NEAR(column(recording, "home.y").back(), place, zero_error);
  EXPECT_NEAR(column(recording, "machine_side.position").back(), place + goal, zero_error + 1e-6);
  // The change of the origin is no step: neither in the error nor in the command.
  const size_t at = first_row_of(recording, homed);
  const auto &error = column(recording, "error.sum"), &command = column(recording, "control.command");
  EXPECT_LT(std::fabs(error[at] - error[at - 1]), 1e-5);
  EXPECT_LT(std::fabs(command[at] - command[at - 1]), 0.5);
  const auto greatest = [](const std::vector<double>& values) {
    return std::fabs(*std::ranges::max_element(values, {}, [](double x) { return std::fabs(x); }));
  };
  EXPECT_LT(greatest(error), 1e-3);
  EXPECT_LT(greatest(command), 10.0);
}

/// The command is zero from the sample at which the fault is seen, however far the axis is from its
/// reference.
void expect_switched_off(const Recording& recording, const std::vector<int>& states) {
  EXPECT_EQ(states_of(recording), states);
  const size_t at = first_row_of(recording, fault);
  const auto &error = column(recording, "error.sum"), &command = column(recording, "control.command");
  ASSERT_LT(at, command.size());
  EXPECT_GT(std::fabs(error[at - 1]), 1e-3);
  EXPECT_NE(command[at - 1], 0);
  for (size_t row = at; row < command.size(); ++row) ASSERT_EQ(command[row], 0) << row;
}

RunResult simulated(const std::vector<std::pair<std::string, std::string>>& set = {}) {
  LoadOptions options;
  options.set = set;
  const RunResult result = simulate(*load_plan(diagram, options));
  EXPECT_EQ(result.status, RunStatus::finished) << result.message;
  return result;
}

TEST(Homing, InSimulationFindsTheSwitchAndMoves) {
  // The encoder counts from the start: the switch is where the axis did not stand.
  for (const double start : {0.0373, 0.0011, 0.0999}) {
    const auto result = simulated({{"machine_side.initial_position", fmt::format("{} m", start)}});
    expect_homed_and_moved(result.recording, -start);
  }
}

TEST(Homing, InSimulationAnAxisThatIsBlockedIsSwitchedOff) {
  expect_switched_off(simulated({{"machine_side.jam_at", "0.5"}}).recording, {off, search, fault});
  expect_switched_off(simulated({{"machine_side.jam_at", "1.5"}}).recording,
                      {off, search, turn, leave, homed, move, fault});
}

TEST(Homing, InSimulationASwitchThatIsNotThereIsMissed) {
  const auto result = simulated({{"longest", "0.2 s"}});
  EXPECT_EQ(states_of(result.recording), (std::vector<int>{off, search, fault}));
  EXPECT_EQ(column(result.recording, "control.command").back(), 0);
}

hw::DeployResult deployed() {
  LoadOptions options;
  options.variants["machine_side"] = "card";
  const auto plan = load_plan(diagram, options);
  Problems problems;
  const hw::Hardware hardware = hw::find_hardware(*plan, problems);
  EXPECT_EQ(problems.text(), "");
  auto driver = hw::find_driver(hardware.device->driver)->make(hardware.device, problems);
  EXPECT_EQ(problems.text(), "");
  hw::IoDevice device(hardware.device, std::move(driver));
  return hw::deploy(*plan, hardware, device, {});
}

/// An axis 40 mm above its switch.
hw::EmulatedCard card_with_switch(double place) {
  hw::EmulatedCard card;
  card.set("plant.position", place + 0.04);
  card.set("switch.position", place), card.set("switch.volts", 5);
  return card;
}

TEST(Homing, OnTheCardFindsTheSwitchAndMoves) {
  constexpr double place = 0.0123, start = 0.04;  // m, of the switch, and from there to the axis
  const hw::EmulatedCard card = card_with_switch(place);
  const hw::DeployResult result = deployed();
  EXPECT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_EQ(result.outputs_safe, hw::OutputsSafe::confirmed);
  expect_homed_and_moved(result.recording, -start);
  EXPECT_NEAR(card.get("plant.position"), place + goal, 1e-4) << "of the motor itself";
  EXPECT_EQ(card.get("dac.0"), 0);
}

TEST(Homing, OnTheCardAnEncoderThatStandsStillSwitchesTheAxisOff) {
  const hw::EmulatedCard card = card_with_switch(0.0123);
  card.set("stuck.at", 500);
  const hw::DeployResult result = deployed();
  EXPECT_EQ(result.outputs_safe, hw::OutputsSafe::confirmed);
  expect_switched_off(result.recording, {off, search, fault});
}

}  // namespace
}  // namespace loopwright::homing_test
