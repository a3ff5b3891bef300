// The paper's loop on the emulated card, in virtual time.
#include "hw/realtime/deploy.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <csignal>
#include "tests/hw/deployment.h"
#include "where.h"

namespace loopwright::hw::deploy_test {
namespace {

using testing::HasSubstr;

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (double v : values) sum += v * v;
  return std::sqrt(sum / double(values.size()));
}

TEST(Deploy, TheStageFollowsItsReferenceAndEndsSafely) {
  EmulatedCard card;
  Deployed deployed(in_virtual_time);
  const DeployResult result = deployed.run();
  EXPECT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
  EXPECT_EQ(result.statistics.cycles, 3101);
  EXPECT_EQ(result.recording.rows(), 3101u);
  EXPECT_EQ(result.statistics.dropped_rows, 0);
  EXPECT_NEAR(column(result.recording, "stage.position").back(), 0.6, 1e-4);
  EXPECT_LT(rms(column(result.recording, "error.sum")), 1e-4);
  EXPECT_EQ(card.get("dac.0"), 0);
  EXPECT_EQ(card.get("open"), 0);
  EXPECT_EQ(card.get("watchdog.armed"), 0);
}

TEST(Deploy, LatenessBacklogAndWatchdogMarginAreThoseOfTheCard) {
  EmulatedCard card;
  card.set("compute", 0.3e-3);
  card.set("stall.at", 100), card.set("stall.seconds", 1.2e-3);
  Deployed deployed;
  EmulatedTime time(card);
  DeployOptions options;
  options.clock = &time;
  const DeployResult result = deployed.run(options);
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_NEAR(1e-9 * double(result.statistics.lateness.longest_ns()), 1.2e-3, 1e-6);
  EXPECT_EQ(result.statistics.lateness.longest_cycle(), 99) << "two samples came before the first cycle";
  EXPECT_EQ(result.statistics.longest_backlog, 1);
  EXPECT_EQ(result.statistics.overruns, 1);
  EXPECT_NEAR(result.statistics.least_watchdog_margin_s, 0.01 - 2.2e-3, 1e-5);
}

TEST(Deploy, OverrunsInARowEndTheRunAndNameTheSlowestBlocks) {
  EmulatedCard card;
  card.set("compute", 1.1e-3);
  Deployed deployed(R"({"clock": {"buffer": 100}})");
  EmulatedTime time(card);
  DeployOptions options;
  options.clock = &time;
  const DeployResult result = deployed.run(options);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_EQ(result.statistics.most_overruns_in_row, 3);
  EXPECT_EQ(result.statistics.cycles, 3);
  EXPECT_THAT(result.message, HasSubstr("the slowest blocks: "));
  EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
}

TEST(Deploy, OverrunsAreOnlyCountedWhereThePolicySaysSo) {
  EmulatedCard card;
  card.set("stall.at", 100), card.set("stall.seconds", 5.5e-3);
  Deployed deployed(R"({"clock": {"buffer": 100}, "policy": {"on_overrun": "count"}})");
  EmulatedTime time(card);
  DeployOptions options;
  options.clock = &time;
  const DeployResult result = deployed.run(options);
  EXPECT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_EQ(result.statistics.longest_backlog, 5);
  EXPECT_GE(result.statistics.overruns, 5);
}

TEST(Deploy, AnUnpluggedCardFailsTheRunWithItsOutputsUnknown) {
  EmulatedCard card;
  card.set("unplug.at", 2000);
  Deployed deployed(in_virtual_time);
  const DeployResult result = deployed.run();
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_EQ(result.outputs_safe, OutputsSafe::unknown);
  EXPECT_EQ(result.fault.code, Code::disconnected);
  EXPECT_THAT(result.message, HasSubstr("-1160"));
  EXPECT_EQ(result.recording.rows(), 1999u) << "what was measured is kept";
}

TEST(Deploy, AReadErrorEndsWithTheOutputsSafe) {
  EmulatedCard card;
  card.set("fault.read.code", 1202), card.set("fault.read.from", 1000);
  Deployed deployed(in_virtual_time);
  const DeployResult result = deployed.run();
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
  EXPECT_EQ(card.get("dac.0"), 0);
}

TEST(Deploy, AnExpiredWatchdogIsReportedAsWhoMadeItSafe) {
  EmulatedCard card;
  card.set("stall.at", 500), card.set("stall.seconds", 0.02);
  Deployed deployed(R"({"clock": {"buffer": 100, "time": "simulated"}})");
  const DeployResult result = deployed.run();
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_EQ(result.outputs_safe, OutputsSafe::by_watchdog);
  EXPECT_EQ(card.get("dac.0"), 0);
}

TEST(Deploy, AReadThatDoesNotReturnIsEndedFromOutside) {
  EmulatedCard card;
  card.set("hang.at", 50);
  Deployed deployed(in_virtual_time);
  DeployOptions options;
  options.read_timeout = 0.2;
  const DeployResult result = deployed.run(options);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_THAT(result.message, HasSubstr("did not return"));
  EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
}

TEST(Deploy, AStepThatFaultsNamesItsBlock) {
  DiagramFolder folder;
  folder.with("device.json", device_text(in_virtual_time));
  folder.with("top.json", R"({"loopwright": 1, "solver": {"stop": 1, "step": 0.001}, "blocks": {
      "table": {"type": "RecordedColumn", "file": "short.csv", "column": "u", "beyond": "fault"},
      "stage": {"variants": {"quanser": {"type": "HardwareIo", "device": "device.json", "sample_time": 0.001}},
                "in": {"command": "table.value"}}}})");
  folder.with("short.csv", "t,u [V]\n0,0\n0.1,0.01\n0.2,0\n");
  EmulatedCard card;
  Deployed deployed(in_virtual_time, {}, folder.path("top.json"));
  const DeployResult result = deployed.run();
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_THAT(result.message, HasSubstr("\"table\" stopped the run at t = 0.2"));
  EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
}

TEST(Deploy, TheComputersClockPacesTheLoopWhereTheDeviceHasNone) {
  EmulatedCard card;
  card.set("real_time", 1);
  LoadOptions short_run;
  short_run.set = {{"solver.stop", "0.2"}};
  Deployed deployed(
      R"({"clock": {"source": "host"}, "policy": {"on_overrun": "count", "most_skipped": 400}, "watchdog": {"timeout": 0.4}})",
      short_run);
  const int64_t start = wall_ns();
  const DeployResult result = deployed.run();
  EXPECT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_LE(result.statistics.cycles, 201);
  EXPECT_GE(result.statistics.cycles + result.statistics.skipped_periods, 201)
      << "a busy computer may skip some";
  EXPECT_GE(wall_ns() - start, 199'000'000);
  EXPECT_EQ(std::ranges::count(card.calls(), "hil_task_create_reader"), 0);
}

TEST(Deploy, ALogWithoutRoomDropsRowsAndCountsThem) {
  EmulatedCard card;
  Deployed deployed(in_virtual_time);
  DeployOptions options;
  options.memory_bytes = 100 * 14 * sizeof(double);
  const DeployResult result = deployed.run(options);
  EXPECT_EQ(result.status, RunStatus::finished);
  EXPECT_EQ(int64_t(result.recording.rows()) + result.statistics.dropped_rows, 3101);
  EXPECT_GT(result.statistics.dropped_rows, 2900);
}

TEST(Deploy, RealTimeThatIsNotGrantedIsRefusedBeforeTheDeviceIsOpened) {
  EmulatedCard card;
  Deployed deployed;
  DeployOptions options;
  options.system.processor = 1000;  // no computer has it
  options.require_real_time = true;
  const DeployResult result = deployed.run(options);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_THAT(result.message, HasSubstr("processor 1000 only"));
  EXPECT_TRUE(card.calls().empty());
}

TEST(Deploy, UnitsOfDiagramAndDeviceMustAgree) {
  DiagramFolder folder;
  folder.with("device.json", device_text(R"({"outputs": {"drive": {"unit": "N"}}})"));
  LoadOptions options;
  options.variants["stage"] = "quanser";
  options.set.emplace_back("stage.device", folder.path("device.json"));
  try {
    load_plan(LOOPWRIGHT_SOURCE "/diagrams/linear_motor/conventional.json", options);
    FAIL() << "newtons of the device are no volts of the controller";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("stage.command [N] is wired to controller.command.y [V]"));
  }
}

}  // namespace
}  // namespace loopwright::hw::deploy_test
