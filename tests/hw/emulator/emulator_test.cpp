// The emulated card and its motor, compared with analytic results, never with the simulator.
#include <gtest/gtest.h>
#include <cmath>
#include "tests/hw/emulator/hil.h"

namespace emulator_test {
namespace {

const uint32_t first = 0;

class Emulator : public testing::Test {
 protected:
  void SetUp() override {
    hil_emu_set("reset", 0);
    for (const char* name : {"cogging", "cogging_2", "damping", "drag", "current_lag"}) plant(name, 0);
    plant("mass", 2), plant("stop_high", 100);
    ASSERT_EQ(hil_open("qpid_e", "0", &card_), 0);
  }
  void TearDown() override {
    if (card_) hil_close(card_);
  }
  static void plant(const std::string& name, double value) {
    ASSERT_TRUE(hil_emu_set(("plant." + name).c_str(), value)) << name;
  }
  static double plant(const std::string& name) { return hil_emu_get(("plant." + name).c_str()); }
  int write(double volts) { return hil_write_analog(card_, &first, 1, &volts); }
  int32_t counts() {
    int32_t value = 0;
    EXPECT_EQ(hil_read_encoder(card_, &first, 1, &value), 0);
    return value;
  }
  tag_task* reader(uint32_t buffer, double hz = 1000) {
    tag_task* task = nullptr;
    EXPECT_EQ(hil_task_create_reader(card_, buffer, nullptr, 0, &first, 1, nullptr, 0, nullptr, 0, &task), 0);
    EXPECT_EQ(hil_task_start(task, 0, hz, uint32_t(-1)), 0);
    return task;
  }
  static int read(tag_task* task) {
    int32_t value = 0;
    return hil_task_read(task, 1, nullptr, &value, nullptr, nullptr);
  }
  tag_card* card_ = nullptr;
};

TEST_F(Emulator, AFreeMassUnderConstantForceFollowsTheParabola) {
  hil_emu_set("dac.bits", 0);
  write(4);  // 4 N on 2 kg
  hil_emu_set("advance", 0.1);
  EXPECT_NEAR(plant("velocity"), 0.2, 1e-12);
  EXPECT_NEAR(plant("position"), 0.01, 4e-6) << "a step of 20 us is off by a v dt/2";
}

TEST_F(Emulator, ViscousFrictionGivesTheTerminalVelocityAndItsTimeConstant) {
  hil_emu_set("dac.bits", 0);
  plant("damping", 8);
  write(4);
  hil_emu_set("advance", 0.25);  // one time constant, m/d
  EXPECT_NEAR(plant("velocity"), 0.5 * (1 - std::exp(-1.0)), 2e-5);
  hil_emu_set("advance", 5);
  EXPECT_NEAR(plant("velocity"), 0.5, 1e-6);
}

TEST_F(Emulator, TheCurrentLoopIsAFirstOrderLag) {
  hil_emu_set("dac.bits", 0);
  plant("current_lag", 0.4e-3);
  write(1);
  hil_emu_set("advance", 0.4e-3);
  EXPECT_NEAR(plant("current"), 1 - std::exp(-1.0), 1e-12);
}

TEST_F(Emulator, CoggingHoldsTheMotorAtItsDetents) {
  plant("cogging", 2), plant("cogging_phase", 0), plant("damping", 20), plant("position", 0.004);
  hil_emu_set("advance", 5);
  EXPECT_NEAR(plant("position"), 0, 1e-6) << "F = -2 N sin(2 pi x / 22.5 mm) pulls to x = 0";
}

TEST_F(Emulator, EndStopsThrowTheMotorBack) {
  plant("stop_high", 0.01), plant("restitution", 0.5), plant("velocity", 1);
  hil_emu_set("advance", 0.015);
  EXPECT_NEAR(plant("velocity"), -0.5, 1e-9);
  EXPECT_LT(plant("position"), 0.01);
}

TEST_F(Emulator, TheEncoderCountsDownwardsAndWrapsInBothDirections) {
  plant("position", 0.4999e-6);
  EXPECT_EQ(counts(), 2);
  plant("position", -1e-9);
  EXPECT_EQ(counts(), -1);
  const double half = std::ldexp(1.0, 23) * 2e-7;
  plant("position", half - 1e-8);
  EXPECT_EQ(counts(), (1 << 23) - 1);
  plant("position", half + 1e-8);
  EXPECT_EQ(counts(), -(1 << 23));
  plant("position", -half - 1e-8);
  EXPECT_EQ(counts(), (1 << 23) - 1);
  hil_emu_set("encoder.bits", 32);
  EXPECT_EQ(counts(), -(1 << 23) - 1);
}

TEST_F(Emulator, QuadratureAndPresetChangeTheCounts) {
  plant("position", 8e-6);
  const int32_t one = 1, preset = -1000;
  ASSERT_EQ(hil_set_encoder_quadrature_mode(card_, &first, 1, &one), 0);
  EXPECT_EQ(counts(), 10);
  ASSERT_EQ(hil_set_encoder_counts(card_, &first, 1, &preset), 0);
  EXPECT_EQ(counts(), -1000);
}

TEST_F(Emulator, TheConverterRoundsClampsAndNeverPutsOutNaN) {
  write(1.0001);
  const double lsb = 20.0 / 65536;
  EXPECT_EQ(hil_emu_get("dac.0"), lsb * std::round(1.0001 / lsb));
  write(12);
  EXPECT_EQ(hil_emu_get("dac.0"), 10);
  write(NAN);
  EXPECT_EQ(hil_emu_get("dac.0"), 0);
  EXPECT_EQ(hil_emu_get("dac.nan"), 1);
}

TEST_F(Emulator, ATaskDeliversOneSampleAPeriodAndNoneOnceStopped) {
  tag_task* task = reader(2);
  for (int i = 1; i <= 5; ++i) {
    EXPECT_EQ(read(task), 1);
    EXPECT_NEAR(hil_emu_get("time"), 1e-3 * i, 1e-12);
  }
  EXPECT_EQ(hil_task_stop(task), 0);
  EXPECT_EQ(read(task), 0);
  EXPECT_EQ(hil_task_delete(task), 0);
  EXPECT_EQ(read(task), -105);
}

TEST_F(Emulator, AFullBufferFailsOrDropsAsAsked) {
  tag_task* task = reader(2);
  hil_emu_set("advance", 0.0035);
  EXPECT_EQ(read(task), -111);
  hil_task_delete(task);
  task = reader(1);
  ASSERT_EQ(hil_task_set_buffer_overflow_mode(task, 1), 0);
  hil_emu_set("advance", 0.0035);
  EXPECT_EQ(read(task), 1);
  EXPECT_EQ(hil_task_get_buffer_overflows(task), 2);
  EXPECT_EQ(hil_task_set_buffer_overflow_mode(task, 3), -1265);
  EXPECT_EQ(hil_task_set_buffer_overflow_mode(task, 9), -1080);
}

TEST_F(Emulator, TheWatchdogExpiresAtItsInstantAndProtectsUntilCleared) {
  const double safe = 0;
  ASSERT_EQ(hil_watchdog_set_analog_expiration_state(card_, &first, 1, &safe), 0);
  ASSERT_EQ(hil_watchdog_start(card_, 0.01), 0);
  write(5);
  hil_emu_set("advance", 0.009);
  EXPECT_EQ(hil_watchdog_reload(card_), 1);
  hil_emu_set("advance", 0.05);
  EXPECT_NEAR(hil_emu_get("watchdog.expired_at"), 0.019, 1e-9);
  EXPECT_EQ(hil_emu_get("dac.0"), 0);
  EXPECT_EQ(hil_watchdog_reload(card_), 0);
  EXPECT_EQ(hil_watchdog_is_expired(card_), 1);
  EXPECT_LT(write(5), 0);
  EXPECT_EQ(hil_watchdog_clear(card_), 0);
  EXPECT_EQ(write(5), 0);
  EXPECT_EQ(hil_watchdog_start(card_, 1.0), -151);
}

TEST_F(Emulator, ASampleIsTakenAtTheInstantAtWhichTheWatchdogExpires) {
  const double safe = 0;
  ASSERT_EQ(hil_watchdog_set_analog_expiration_state(card_, &first, 1, &safe), 0);
  tag_task* task = reader(2);
  ASSERT_EQ(hil_watchdog_start(card_, 0.001), 0);
  write(5);
  EXPECT_EQ(read(task), 1);
  EXPECT_EQ(hil_watchdog_reload(card_), 0) << "it has expired";
  EXPECT_EQ(hil_emu_get("dac.0"), 0);
  EXPECT_EQ(hil_emu_get("watchdog.expired_at"), 0.001);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(read(task), 1) << "the card samples all the same";
}

TEST_F(Emulator, TwoTasksSampleAtTheSameInstant) {
  tag_task *one = reader(2), *two = nullptr;
  ASSERT_EQ(hil_task_create_reader(card_, 2, nullptr, 0, &first, 1, nullptr, 0, nullptr, 0, &two), 0);
  ASSERT_EQ(hil_task_start(two, 2, 1000, uint32_t(-1)), 0);
  for (int i = 1; i <= 3; ++i) {
    EXPECT_EQ(read(one), 1);
    EXPECT_EQ(read(two), 1);
    EXPECT_NEAR(hil_emu_get("time"), 1e-3 * i, 1e-12);
  }
}

TEST_F(Emulator, ExpiryValuesCanBeRestrictedAsSomeCardsDo) {
  const double one = 1;
  hil_emu_set("watchdog.zero_only", 1);
  EXPECT_EQ(hil_watchdog_set_analog_expiration_state(card_, &first, 1, &one), -601);
  hil_emu_set("watchdog.needs_all", 1);
  EXPECT_EQ(hil_watchdog_start(card_, 0.01), -604);
}

TEST_F(Emulator, WrongCallsGetTheDocumentedCodes) {
  tag_card* second = nullptr;
  EXPECT_EQ(hil_open("qpid_e", "0", &second), -1073);
  EXPECT_EQ(hil_open("no_such_board", "0", &second), -179);
  EXPECT_EQ(hil_open("qpid_e", "7", &second), -108);
  EXPECT_EQ(hil_open("qpid_e", nullptr, &second), -399);
  const uint32_t eight = 8;
  double volts = 0;
  int32_t count = 0;
  char level = 0;
  EXPECT_EQ(hil_write_analog(card_, &eight, 1, &volts), -133);
  EXPECT_EQ(hil_write_analog(card_, &first, 1, nullptr), -164);
  EXPECT_EQ(hil_read_encoder(card_, &eight, 1, &count), -124);
  EXPECT_EQ(hil_read_analog(card_, &eight, 1, &volts), -121);
  EXPECT_EQ(hil_read_digital(card_, &first, 1, &level), -446);
  tag_task* task = nullptr;
  EXPECT_EQ(hil_task_create_reader(card_, 0, nullptr, 0, &first, 1, nullptr, 0, nullptr, 0, &task), -320);
  tag_task* running = reader(2);
  ASSERT_EQ(hil_task_create_reader(card_, 2, nullptr, 0, &first, 1, nullptr, 0, nullptr, 0, &task), 0);
  EXPECT_EQ(hil_task_start(task, 0, 1000, 1), -145);
  EXPECT_EQ(hil_task_start(task, 1, 1000, 1), -144) << "clock 1 is the watchdog";
  EXPECT_EQ(hil_task_start(task, 2, 0, 1), -149);
  EXPECT_EQ(hil_task_start(task, 2, 1e6, 1), -150);
  EXPECT_EQ(hil_task_start(task, 2, 1, 1), -151);
  int32_t three[3];
  EXPECT_EQ(hil_task_read(running, 3, nullptr, three, nullptr, nullptr), -159);
  EXPECT_EQ(hil_task_read(running, 1, nullptr, nullptr, nullptr, nullptr), -161);
  EXPECT_EQ(hil_set_card_specific_options(card_, "unknown=1", 10), -573);
  const double low = -20, high = 20;
  EXPECT_EQ(hil_set_analog_output_ranges(card_, &first, 1, &low, &high), -398);
  hil_close(card_);
  EXPECT_EQ(write(0), -88);
  card_ = nullptr;
}

TEST_F(Emulator, AFaultComesAtItsCallAndAnUnpluggedCardKeepsItsOutput) {
  hil_emu_set("fault.write.code", 843), hil_emu_set("fault.write.from", 1),
      hil_emu_set("fault.write.count", 1);
  EXPECT_EQ(write(1), 0);
  EXPECT_EQ(write(2), -843);
  EXPECT_EQ(write(3), 0);
  hil_emu_set("unplug.at", 2);
  tag_task* task = reader(2);
  EXPECT_EQ(read(task), 1);
  EXPECT_EQ(read(task), 1);
  EXPECT_EQ(read(task), -1160);
  EXPECT_EQ(write(0), -1160);
  EXPECT_NEAR(hil_emu_get("dac.0"), 3, 2e-4);
}

}  // namespace

}  // namespace emulator_test
