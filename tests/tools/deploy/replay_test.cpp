// The same plan simulated, deployed and replayed: close, as two motors with the same parameters are, and
// equal in every bit if the same blocks processed the same numbers.
#include "tools/deploy/replay.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include "engine/record/recording_file.h"
#include "tests/hw/deployment.h"
#include "where.h"

namespace loopwright::replay_test {
namespace {

using hw::column;
using hw::Deployed;
using hw::EmulatedCard;
using testing::HasSubstr;

const std::string conventional = LOOPWRIGHT_SOURCE "/diagrams/linear_motor/conventional.json";

RunResult simulated_without_noise() {
  LoadOptions options;
  options.set = {{"stage.command_noise", "0"}, {"stage.encoder_noise", "0"}, {"solver.record_step", "0.001"}};
  return simulate(*load_plan(conventional, options));
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}
double largest(const std::vector<double>& values) {
  return largest_difference(values, std::vector<double>(values.size()));
}

struct Agreement {
  double position = 0, command = 0, error = 0;  ///< largest differences; m, V, m
};
/// The emulated motor has the parameters of the simulated stage from the start, except for its current loop.
Agreement agreement() {
  EmulatedCard card;
  card.set("plant.current_lag", 0);
  // The run begins with its first sample, as the simulation does, and not after two that agree, because
  // cogging moves the motor meanwhile.
  const hw::DeployResult deployed =
      Deployed(R"({"clock": {"time": "simulated"}, "inputs": {"position": {"maximum_rate": 0}}})").run();
  EXPECT_EQ(deployed.status, RunStatus::finished) << deployed.message;
  const RunResult simulated = simulated_without_noise();
  const auto difference = [&](const char* name) {
    EXPECT_EQ(column(deployed.recording, name).size(), column(simulated.recording, name).size());
    return largest_difference(column(deployed.recording, name), column(simulated.recording, name));
  };
  return {difference("stage.position"), difference("controller.command"), difference("error.sum")};
}

TEST(SimulatedAndDeployed, AgreeWithinSomeCountsOfTheEncoder) {
  const Agreement same = agreement();
  EXPECT_LT(same.position, 5e-6) << "25 counts; the error itself reaches ten times as much";
  EXPECT_LT(same.command, 0.25);
}

Replay replayed(const Deployed& deployed, const Recording& log) {
  Problems problems;
  Replay result = replay(*deployed.plan, deployed.hardware, log, problems);
  EXPECT_EQ(problems.text(), "");
  return result;
}

TEST(Replay, EveryOutputIsEqualInEveryBitAlsoAfterTheFile) {
  EmulatedCard card;
  card.set("plant.payload", 0.2);
  Deployed deployed(hw::in_virtual_time);
  const hw::DeployResult result = deployed.run();
  EXPECT_GT(largest(column(result.recording, "controller.disturbance")), 0.1)
      << "there is something to replay";
  for (const char* name : {"log.csv", "log.mat"}) {
    DiagramFolder folder;
    write_recording(folder.path(name), result.recording);
    Problems problems;
    const Replay again = replayed(deployed, read_recording(folder.path(name), problems));
    EXPECT_EQ(problems.text(), "");
    EXPECT_TRUE(again.explains()) << to_text(again);
    EXPECT_EQ(again.rows, 3101);
    EXPECT_EQ(again.other_build, "");
    EXPECT_GE(again.columns.size(), 6u);
  }
}

TEST(Replay, ALogWithLostSamplesIsEqualInEveryBitToo) {
  for (const char* policy : {"fault", "hold"}) {
    EmulatedCard card;
    card.set("lose.every", 50), card.set("lose.length", 2), card.set("lose.told", 1);
    Deployed deployed(fmt::format(
        R"({{"clock": {{"overflow": "overwrite", "time": "simulated"}}, "policy": {{"on_lost": "{}"}}}})",
        policy));
    const hw::DeployResult result = deployed.run();
    ASSERT_EQ(result.statistics.lost_samples, 124) << result.message;
    DiagramFolder folder;
    write_recording(folder.path("log.csv"), result.recording);
    Problems problems;
    Recording log = read_recording(folder.path("log.csv"), problems);
    const Replay again = replayed(deployed, log);
    EXPECT_TRUE(again.explains()) << to_text(again);
    EXPECT_EQ(again.rows, 3101 - 124);
    for (Column& c : log.columns)
      if (c.name == "loop.lost") c.values[49] += 1;
    EXPECT_THAT(replayed(deployed, log).fault, HasSubstr("the log has a hole"));
  }
}

TEST(Replay, AChangedLogDoesNotExplainThePlan) {
  EmulatedCard card;
  Deployed deployed(hw::in_virtual_time);
  hw::DeployResult result = deployed.run();
  for (Column& c : result.recording.columns)
    if (c.name == "stage.position") c.values[1500] += 2e-7;
  const Replay changed = replayed(deployed, result.recording);
  EXPECT_FALSE(changed.explains());
  for (const ReplayedColumn& c : changed.columns)
    if (c.name == "controller.command") {
      EXPECT_EQ(c.first_row, 1500);
      EXPECT_GT(c.differing, 1);
    }
}

TEST(Replay, ALogOfAnotherPlanIsRefused) {
  EmulatedCard card;
  hw::DeployResult result = Deployed(hw::in_virtual_time).run();
  LoadOptions options;
  options.set = {{"controller.observer_cutoff", "200"}};
  const Deployed other(hw::in_virtual_time, options);
  Problems problems;
  replay(*other.plan, other.hardware, result.recording, problems);
  EXPECT_THAT(problems.text(), HasSubstr("the diagram or its parameters (--set, --variant) have changed"));

  // Without the facts only the bits can show the difference.
  result.recording.facts.clear();
  const Replay wrong = replayed(other, result.recording);
  EXPECT_FALSE(wrong.explains());
  EXPECT_THAT(to_text(wrong), HasSubstr("do not explain"));
}

TEST(Replay, ALogOfOtherContentsOfAFileIsRefusedByItsName) {
  EmulatedCard card;
  Deployed deployed(hw::in_virtual_time);
  hw::DeployResult result = deployed.run();
  bool has_files = false;
  for (auto& [name, value] : result.recording.facts)
    if (name.starts_with("file ") && name.ends_with(".json")) has_files = true, value = "0123456789abcdef";
  ASSERT_TRUE(has_files);
  Problems problems;
  replay(*deployed.plan, deployed.hardware, result.recording, problems);
  EXPECT_THAT(problems.text(), HasSubstr("has changed"));
  EXPECT_THAT(problems.text(), HasSubstr(".json\""));
}

TEST(Replay, ALogOfAnotherBuildIsReplayedWithAWarning) {
  EmulatedCard card;
  Deployed deployed(hw::in_virtual_time);
  hw::DeployResult result = deployed.run();
  for (auto& [name, value] : result.recording.facts)
    if (name == "build") value = "0123456789abcdef";
  const Replay again = replayed(deployed, result.recording);
  EXPECT_TRUE(again.explains());
  EXPECT_THAT(to_text(again),
              HasSubstr("warning: the log was made by another build of the program (0123456789abcdef"));
}

TEST(Replay, AHoleInTheLogIsFound) {
  EmulatedCard card;
  Deployed deployed(hw::in_virtual_time);
  hw::DeployResult result = deployed.run();
  for (Column& c : result.recording.columns) c.values.erase(c.values.begin() + 700);
  EXPECT_THAT(replayed(deployed, result.recording).fault, HasSubstr("row 701 is at 0.701 s"));
}

/// A device that clamps and slows down what the loop commands.
const std::string narrow =
    R"({"clock": {"time": "simulated"}, "outputs": {"drive": {"maximum": 0.9, "minimum": -0.6, "maximum_rate": 30}}})";

Column& column_of(Recording& log, std::string_view name) {
  for (Column& column : log.columns)
    if (column.name == name) return column;
  throw std::invalid_argument("no column " + std::string(name));
}

const ReplayedColumn& of(const Replay& replay, std::string_view name) {
  for (const ReplayedColumn& column : replay.columns)
    if (column.name == name) return column;
  throw std::invalid_argument("not replayed: " + std::string(name));
}

TEST(Replay, WhatTheDeviceAppliedIsTheCommandWithinItsLimits) {
  EmulatedCard card;
  Deployed deployed(narrow);
  hw::DeployResult result = deployed.run();
  ASSERT_GT(result.statistics.clamped, 0) << result.message;
  ASSERT_GT(result.statistics.rate_limited, 0);
  const Replay again = replayed(deployed, result.recording);
  EXPECT_TRUE(again.explains()) << to_text(again);
  EXPECT_EQ(of(again, "stage.applied").differing, 0);

  std::vector<double>& applied = column_of(result.recording, "stage.applied").values;
  const double right = applied[700];
  applied[700] = std::nextafter(right, 9.0);
  const Replay edited = replayed(deployed, result.recording);
  EXPECT_FALSE(edited.explains());
  EXPECT_EQ(of(edited, "stage.applied").differing, 1);
  EXPECT_EQ(of(edited, "stage.applied").first_row, 700);
  applied = column_of(result.recording, "stage.command").values;
  EXPECT_FALSE(replayed(deployed, result.recording).explains()) << "the limits are those of the device file";
}

TEST(Replay, WhatCannotBeVerifiedIsNamed) {
  EmulatedCard card;
  Deployed deployed(hw::in_virtual_time);
  hw::DeployResult result = deployed.run();
  result.recording.columns.push_back(
      {"added", "", std::vector<double>(result.recording.columns[0].values.size())});
  const Replay again = replayed(deployed, result.recording);
  EXPECT_THAT(again.taken, testing::ElementsAre("stage.position", "loop.lateness", "loop.step_time", "added",
                                                "outputs_safe"));
  EXPECT_THAT(to_text(again), HasSubstr("not verified: stage.position, loop.lateness, loop.step_time"));
}

TEST(Replay, ALogThatWasCutShortIsToldAndIsNoExplanation) {
  EmulatedCard card;
  Deployed deployed(hw::in_virtual_time);
  hw::DeployResult result = deployed.run();
  Recording log = result.recording;
  for (Column& c : log.columns) c.values.resize(500);
  const Replay counted = replayed(deployed, log);
  EXPECT_FALSE(counted.explains());
  EXPECT_THAT(counted.fault,
              HasSubstr("rows after 0.499 s are missing: the log states 3101 rows and has 500"));

  std::erase_if(log.facts, [](const auto& fact) { return fact.first == "rows"; });
  const Replay uncounted = replayed(deployed, log);
  EXPECT_FALSE(uncounted.explains());
  EXPECT_THAT(uncounted.fault, HasSubstr("rows after 0.499 s are missing: the run ends at 3.1 s"));

  log.facts.emplace_back("incomplete", "interrupted by SIGINT");
  const Replay interrupted = replayed(deployed, log);
  EXPECT_TRUE(interrupted.explains()) << to_text(interrupted);
  EXPECT_THAT(to_text(interrupted), HasSubstr("the log states that it is incomplete: interrupted by SIGINT"));
}

TEST(Replay, SamplesThatWereNotLostAreNoGap) {
  EmulatedCard card;
  Deployed deployed(hw::in_virtual_time);
  hw::DeployResult result = deployed.run();
  column_of(result.recording, "loop.lost").values[0] = 2;
  EXPECT_THAT(replayed(deployed, result.recording).fault, HasSubstr("row 1: loop.lost is 2"));
  column_of(result.recording, "loop.lost").values[0] = 0;
  column_of(result.recording, "loop.lost").values[8] = 0.5;
  EXPECT_THAT(replayed(deployed, result.recording).fault, HasSubstr("row 9: loop.lost is 0.5"));
}

TEST(Replay, AMissingColumnIsAProblem) {
  EmulatedCard card;
  Deployed deployed(hw::in_virtual_time);
  Recording log = deployed.run().recording;
  std::erase_if(log.columns, [](const Column& c) { return c.name == "stage.position"; });
  Problems problems;
  replay(*deployed.plan, deployed.hardware, log, problems);
  EXPECT_THAT(problems.text(), HasSubstr("no column \"stage.position\""));
}

}  // namespace
}  // namespace loopwright::replay_test
