// The main guarantees of a deployment again, on a card behind a library that shares nothing with the emulated
// one.
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include "tests/hw/deployment.h"
#include "tests/hw/lookalike/card.h"

namespace loopwright::hw::safety_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Lookalike : public testing::Test {
 protected:
  void SetUp() override {
    const std::string path = LOOPWRIGHT_BINARY "/lib/libhil_lookalike.so";
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    ASSERT_NE(library, nullptr) << dlerror();
    card = reinterpret_cast<LookalikeReset*>(dlsym(library, "lookalike_reset"))();
    setenv("HIL_LIBRARY", path.c_str(), 1);
  }
  /// Deploys, and compares the reported state of the outputs with the card.
  DeployResult run(const std::string& patch = in_virtual_time) {
    DeployResult result = Deployed(patch).run();
    EXPECT_FALSE(card->is_open);
    if (result.outputs_safe != OutputsSafe::unknown) {
      EXPECT_EQ(card->volts[0], 0) << result.message;
    }
    return result;
  }
  LookalikeCard* card = nullptr;
};

const std::string dropping = R"({"clock": {"overflow": "overwrite", "time": "simulated"}})";

TEST_F(Lookalike, TheStageFollowsItsReferenceAndEndsSafely) {
  const DeployResult result = run();
  EXPECT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
  EXPECT_NEAR(card->position, 0.6, 1e-4);
  EXPECT_FALSE(card->is_watched);
}

TEST_F(Lookalike, ACardInUseIsRefusedUntouched) {
  card->is_open = true, card->volts[0] = 1.5;
  Deployed second(in_virtual_time);
  const DeployResult result = second.run();
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_EQ(result.fault.code, Code::busy);
  EXPECT_EQ(result.outputs_safe, OutputsSafe::untouched);
  EXPECT_THAT(result.message, AllOf(HasSubstr("the device is in use"), HasSubstr("-109")));
  EXPECT_EQ(card->calls, 1) << "hil_open alone";
  EXPECT_EQ(card->volts[0], 1.5);
  EXPECT_TRUE(card->is_open);
}

TEST_F(Lookalike, WhatIsTakenOverEndsWithSafeOutputsBeforeAnythingMoves) {
  card->is_open = true, card->volts[0] = 1.5;
  {
    Deployed second(in_virtual_time);
    EXPECT_TRUE(second.device->take_over().ok());
    EXPECT_EQ(second.device->outputs_safe(), OutputsSafe::unknown);
  }
  EXPECT_EQ(card->volts[0], 0);
  EXPECT_FALSE(card->is_open);
}

TEST_F(Lookalike, TheWatchdogIsArmedBeforeAnythingButSafeValuesIsPutOut) {
  const DeployResult result =
      run(R"({"clock": {"time": "simulated"}, "outputs": {"drive": {"initial": 1, "safe": 0}}})");
  EXPECT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_EQ(card->unwatched_peak, 0);
}

TEST_F(Lookalike, ARunWhoseSafeValuesWereRefusedAtItsEndHasFailed) {
  ASSERT_EQ(run().status, RunStatus::finished);
  const int64_t writes = card->writes;
  SetUp();
  card->refused_from = writes - 2;  // those of the stop
  const DeployResult result = run();
  EXPECT_NE(card->volts[0], 0);
  EXPECT_EQ(result.outputs_safe, OutputsSafe::unknown);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_THAT(result.message, HasSubstr("did not confirm its safe values"));
}

IoDevice* device_to_stop = nullptr;

TEST_F(Lookalike, AStopRequestedWhileTheTaskIsDeletedDoesNotUseIt) {
  Deployed deployed(in_virtual_time);
  device_to_stop = deployed.device.get();
  card->in_delete = [] { device_to_stop->request_stop(); };
  EXPECT_EQ(deployed.run().status, RunStatus::finished);
  device_to_stop->request_stop();
  EXPECT_EQ(card->stops_after_delete, 0);
  EXPECT_FALSE(card->is_open);
}

TEST_F(Lookalike, ModelTimeFollowsTheSamplesThatTheCardCounted) {
  card->lost_from = 700, card->lost = 2;
  const DeployResult result = run(dropping);
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_EQ(result.statistics.lost_samples, 2);
  const auto& time = column(result.recording, "time");
  EXPECT_EQ(time[698], 0.698);
  EXPECT_EQ(time[699], 0.701);
  EXPECT_EQ(time.back(), 3.1);
  EXPECT_NEAR(card->position, 0.6, 1e-4);
}

TEST_F(Lookalike, TooManyLostInARowEndTheRun) {
  card->lost_from = 700, card->lost = 3;
  const DeployResult result = run(dropping);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_THAT(result.message, HasSubstr("lost 3 samples in a row"));
  EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
}

TEST_F(Lookalike, AReadingThatCannotBeEndsTheRunOrKeepsItFromBeginning) {
  const std::string with_current =
      R"({"clock": {"time": "simulated"}, "inputs": {"current": {"kind": "analog", "channel": 0, "unit": "A", "scale": 1}}})";
  for (const int64_t at : {0, 1, 900})
    for (const double strange : {std::nan(""), -HUGE_VAL, 1e9}) {
      SetUp();
      card->strange_at = at, card->strange = strange;
      const DeployResult result = run(with_current);
      EXPECT_EQ(result.status, RunStatus::failed);
      EXPECT_THAT(result.message, HasSubstr("input \"current\" (analog 0) read "));
      EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
      if (at < 2) {
        EXPECT_EQ(card->position, 0) << "nothing has moved";
      }
    }
}

TEST_F(Lookalike, ErrorsOfReadsEndWithTheOutputsSafe) {
  for (const int32_t error : {-1, -111, -843, -1202, -1270, -2147483647}) {
    SetUp();
    card->error_from = 400, card->read_error = error;
    const DeployResult result = run();
    EXPECT_EQ(result.status, RunStatus::failed);
    EXPECT_THAT(result.message, HasSubstr(std::to_string(error)));
    EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
  }
}

TEST_F(Lookalike, AnUnpluggedCardLeavesItsOutputsUnknown) {
  card->unplugged_from = 300;
  const DeployResult result = run();
  EXPECT_EQ(result.fault.code, Code::disconnected);
  EXPECT_EQ(result.outputs_safe, OutputsSafe::unknown);
}

TEST_F(Lookalike, AnExpiredWatchdogIsReportedWhetherWritesFailOrAreIgnored) {
  for (const bool silent : {true, false}) {
    SetUp();
    card->stays_expired_in_silence = silent;
    card->stalled_at = 500, card->stalled_for = 0.02;
    const DeployResult result = run(R"({"clock": {"buffer": 100, "time": "simulated"}})");
    EXPECT_EQ(result.status, RunStatus::failed);
    EXPECT_EQ(result.outputs_safe, OutputsSafe::by_watchdog);
  }
}

TEST_F(Lookalike, AFullBufferIsAFaultOrLosesTheOldest) {
  card->stalled_at = 500, card->stalled_for = 0.004;
  EXPECT_EQ(run(R"({"clock": {"time": "simulated"}, "watchdog": {"timeout": 0.1}})").fault.native, -111);
  SetUp();
  card->stalled_at = 500, card->stalled_for = 0.004;
  const DeployResult result =
      run(R"({"clock": {"overflow": "overwrite", "time": "simulated"}, "watchdog": {"timeout": 0.1}})");
  EXPECT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_EQ(result.statistics.lost_samples, 2) << "of four, two are kept";
  EXPECT_EQ(column(result.recording, "time").back(), 3.1);
}

}  // namespace
}  // namespace loopwright::hw::safety_test
