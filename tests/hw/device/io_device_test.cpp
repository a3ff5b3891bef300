// The rules of the port, on a driver that a test controls.
#include "hw/device/io_device.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include "tests/hw/device_file.h"

namespace loopwright::hw::io_device_test {
namespace {

struct Script {
  double raw = 0;
  std::vector<double> raws;  // read one after the other, before `raw`
  size_t filled_inputs = 1;
  int64_t sequence = 0;
  Status read, write;
  bool watchdog_took_over = false;
  std::vector<std::string> calls;
  std::vector<double> written;
};

class ScriptedDriver final : public Driver {
 public:
  explicit ScriptedDriver(Script& script) : script_(script) {}
  Capabilities capabilities() const override { return {true, true, false, true}; }
  Status open() override { return note("open"); }
  Status configure(std::span<const double>) override { return note("configure"); }
  Status start(double) override { return note("start"); }
  std::string describe(Status) const override { return ""; }
  Status read(RawSample& sample, std::span<double> raw) noexcept override {
    sample.sequence = script_.sequence++;
    for (size_t i = 0; i < script_.filled_inputs; ++i)
      raw[i] = script_.raws.empty() ? script_.raw : script_.raws.front();
    if (!script_.raws.empty()) script_.raws.erase(script_.raws.begin());
    return script_.read;
  }
  Status write(std::span<const double> raw) noexcept override {
    script_.written.push_back(raw[0]);
    note("write");
    return script_.write;
  }
  Status kick() noexcept override { return note("kick"); }
  void request_stop() noexcept override {}
  void emergency_stop(std::span<const double> safe) noexcept override { write(safe); }
  void stop_sampling() noexcept override { note("stop_sampling"); }
  void disarm() noexcept override { note("disarm"); }
  bool watchdog_took_over() noexcept override { return script_.watchdog_took_over; }
  void close() noexcept override { note("close"); }
  Status rearm() override { return note("rearm"); }

 private:
  Status note(const char* name) noexcept { return script_.calls.push_back(name), Status{}; }
  Script& script_;
};

struct Bench {
  explicit Bench(const std::string& patch = "{}")
      : device(device_of(patch), std::make_unique<ScriptedDriver>(script)) {
    EXPECT_TRUE(device.open().ok() && device.preset().ok() && device.start(0.001).ok());
    script.written.clear(), script.calls.clear();
  }
  double read(double raw) {
    script.raw = raw;
    std::array<double, 1> value{};
    last = device.read(sample, value);
    return value[0];
  }
  Status write(double value) { return device.write(std::array{value}); }
  Script script;
  IoDevice device;
  Sample sample;
  Status last;
};

TEST(IoDevice, CountsAreUnwrappedInBothDirectionsAtTheWidthOfTheCounter) {
  Bench bench(R"({"inputs": {"position": {"maximum_rate": 0, "scale": 1}}})");
  const double half = 1 << 23;
  EXPECT_EQ(bench.read(half - 1), half - 1);
  EXPECT_EQ(bench.read(-half), half);
  EXPECT_EQ(bench.read(-half + 5), half + 5);
  EXPECT_EQ(bench.read(half - 2), half - 2);
  EXPECT_EQ(bench.read(0), 0);
  EXPECT_EQ(bench.read(-half + 1), -half + 1);
  EXPECT_EQ(bench.read(half - 1), -half - 1);
}

TEST(IoDevice, ACounterOf32BitsIsReadRightAs24) {
  Bench bench(R"({"inputs": {"position": {"maximum_rate": 0, "scale": 1}}})");
  for (double counts = 0; counts < 40e6; counts += 4e6) EXPECT_EQ(bench.read(counts), counts);
}

TEST(IoDevice, ScaleAndHomingOffsetMakePhysicalUnits) {
  Bench bench(R"({"inputs": {"position": {"offset": 0.05, "maximum_rate": 0}}})");
  EXPECT_DOUBLE_EQ(bench.read(100000), 0.07);
}

TEST(IoDevice, AGlitchIsHeldAndThreeInARowAreAFault) {
  Bench bench;  // 3 m/s
  EXPECT_EQ(bench.read(0), 0);
  EXPECT_EQ(bench.read(1e6), 0) << "0.2 m in a millisecond";
  EXPECT_TRUE(bench.last.ok());
  EXPECT_NEAR(bench.read(100), 2e-5, 1e-12);
  for (int i = 0; i < 3; ++i) bench.read(5e6);
  EXPECT_EQ(bench.last.code, Code::device_fault);
  EXPECT_EQ(bench.device.glitches(), 4);
}

TEST(IoDevice, AGlitchThatStaysIsAFaultThatNamesTheChannelAndWhatWasRead) {
  Bench bench;
  bench.read(0);
  for (int i = 0; i < 3; ++i) bench.read(5e6);
  EXPECT_EQ(bench.device.describe(bench.last),
            "input \"position\" (encoder 0) read 5000000 counts, a jump from 0 m beyond its maximum rate of "
            "3 m/s; 3 "
            "bad readings in a row");
}

TEST(IoDevice, AfterLostSamplesAnAxisMayHaveGoneFarther) {
  Bench bench;
  bench.read(0);
  bench.script.sequence += 4;
  EXPECT_NEAR(bench.read(14.9e-3 / 2e-7), 14.9e-3, 1e-9) << "five periods at 3 m/s";
  EXPECT_EQ(bench.sample.lost, 4);
  EXPECT_EQ(bench.device.glitches(), 0);
}

TEST(IoDevice, ASampleNumberedBackwardIsAFault) {
  Bench bench;
  bench.read(0);
  bench.script.sequence = 1;
  bench.read(0);
  EXPECT_EQ(bench.last.code, Code::device_fault);
  EXPECT_EQ(bench.device.describe(bench.last),
            "the device numbered a sample 1 after sample 1: what time it is cannot be told");
}

// ---- impossible raw numbers ----

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

TEST(IoDevice, ANumberThatCannotBeIsAFault) {
  for (const double raw : {nan, inf, -inf, 0.5, 1e10, 4294967296.0, -2147483649.0, 1e300, 1073741824.0}) {
    Bench bench;
    EXPECT_NEAR(bench.read(1000), 2e-4, 1e-12);
    EXPECT_NEAR(bench.read(raw), 2e-4, 1e-12) << "the value before " << raw;
    EXPECT_EQ(bench.last.code, Code::device_fault) << raw;
    EXPECT_EQ(bench.write(4).code, Code::device_fault);
    EXPECT_EQ(bench.script.written.back(), 0);
  }
}

TEST(IoDevice, WhatWasReadIsToldInASentence) {
  const std::pair<double, const char*> sentences[] = {
      {nan, "input \"position\" (encoder 0) read nan counts, which is not finite"},
      {0.5, "input \"position\" (encoder 0) read 0.5 counts: a counter counts whole edges"},
      {1e10,
       "input \"position\" (encoder 0) read 10000000000 counts, which its counter of 24 bits cannot do "
       "(\"counter_bits\")"}};
  for (const auto& [raw, sentence] : sentences) {
    Bench bench;
    bench.read(0), bench.read(raw);
    EXPECT_EQ(bench.device.describe(bench.last), sentence);
  }
}

TEST(IoDevice, ItIsHeldForAStatedNumberOfSamplesWhereThePolicySaysSo) {
  Bench bench(R"({"policy": {"on_invalid": "hold", "most_invalid": 4}})");
  bench.read(1000);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(bench.read(nan), 2e-4, 1e-12);
    EXPECT_TRUE(bench.last.ok());
  }
  EXPECT_NEAR(bench.read(1100), 2.2e-4, 1e-12) << "the row is broken";
  for (int i = 0; i < 4; ++i) bench.read(inf);
  EXPECT_EQ(bench.last.code, Code::device_fault);
}

TEST(IoDevice, NothingBeginsWithANumberThatCannotBe) {
  for (const char* policy : {"{}", R"({"policy": {"on_invalid": "hold"}})"})
    for (const size_t at : {0, 1}) {
      Bench bench(policy);
      bench.script.raws = at == 0 ? std::vector<double>{nan} : std::vector<double>{1000, nan};
      bench.read(1000);
      EXPECT_EQ(bench.last.code, Code::device_fault) << policy << at;
      EXPECT_THAT(bench.device.describe(bench.last), testing::HasSubstr("the diagram has not begun"));
    }
}

TEST(IoDevice, AGlitchInTheFirstSampleIsNotWhereTheMotionBegins) {
  Bench bench;
  bench.script.raws = {5e6};
  EXPECT_NEAR(bench.read(1000), 2e-4, 1e-12) << "the second and the third sample agree";
  EXPECT_TRUE(bench.last.ok());
  EXPECT_EQ(bench.script.sequence, 3);
  EXPECT_EQ(bench.script.written, (std::vector<double>{0, 0})) << "the initial value meanwhile";
}

TEST(IoDevice, FirstSamplesThatNeverAgreeAreAFault) {
  Bench bench;
  bench.script.raws = {0, 5e6, 0, 5e6, 0};
  bench.read(0);
  EXPECT_EQ(bench.last.code, Code::device_fault);
  EXPECT_THAT(
      bench.device.describe(bench.last),
      testing::AllOf(testing::HasSubstr("a jump from"), testing::HasSubstr("the diagram has not begun")));
}

TEST(IoDevice, AnInputThatTheDriverDoesNotFillInIsNoNumber) {
  Bench bench(R"({"inputs": {"current": {"kind": "analog", "channel": 0, "unit": "A", "scale": 1}}})");
  bench.script.filled_inputs = 2;
  bench.read(1);
  EXPECT_TRUE(bench.last.ok());
  bench.script.filled_inputs = 1;
  bench.read(1);
  EXPECT_EQ(bench.last.code, Code::device_fault);
  EXPECT_THAT(bench.device.describe(bench.last),
              testing::HasSubstr("input \"current\" (analog 0) read nan V"));
}

TEST(IoDevice, OutputsAreClampedToTheRangeAndToTheFurtherLimits) {
  Bench bench(R"({"outputs": {"drive": {"scale": 2, "maximum": 6, "maximum_rate": 0}}})");
  bench.write(100);
  EXPECT_EQ(bench.script.written.back(), 3) << "6 units are 3 V";
  bench.write(-100);
  EXPECT_EQ(bench.script.written.back(), -10);
  EXPECT_EQ(bench.device.clamped(), 2);
  EXPECT_EQ(bench.device.applied()[0], -20);
}

TEST(IoDevice, OutputsMoveNoFasterThanTheirRate) {
  Bench bench(R"({"outputs": {"drive": {"maximum_rate": 1000}}})");
  bench.write(5);
  EXPECT_DOUBLE_EQ(bench.script.written.back(), 1);
  bench.write(5);
  EXPECT_DOUBLE_EQ(bench.script.written.back(), 2);
  bench.write(-5);
  EXPECT_DOUBLE_EQ(bench.script.written.back(), 1);
  EXPECT_EQ(bench.device.rate_limited(), 3);
}

TEST(IoDevice, AfterAStopTheFirstCommandIsLimitedFromTheInitialValue) {
  Bench bench(R"({"outputs": {"drive": {"maximum_rate": 1000, "initial": 4}}})");
  bench.write(5);
  EXPECT_DOUBLE_EQ(bench.script.written.back(), 5);
  bench.device.stop();
  ASSERT_TRUE(bench.device.preset().ok() && bench.device.start(0.001).ok());
  EXPECT_EQ(bench.script.written.back(), 4);
  EXPECT_EQ(bench.device.applied()[0], 4);
  bench.write(5);
  EXPECT_DOUBLE_EQ(bench.script.written.back(), 5) << "a volt a period, from 4 V";
}

TEST(IoDevice, AValueThatIsNoNumberIsNeverSentAndLatches) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Bench bench;
    bench.write(4);
    const Status refused = bench.write(bad);
    EXPECT_EQ(refused.code, Code::range);
    EXPECT_THAT(bench.device.describe(refused),
                testing::HasSubstr("the command for output \"drive\" (channel 0) became"));
    EXPECT_EQ(bench.script.written.back(), 0) << "the safe value";
    EXPECT_TRUE(latches(bench.write(4).code));
    EXPECT_EQ(bench.script.written.back(), 0);
  }
}

TEST(IoDevice, ALatchedFaultLetsOnlySafeValuesOutUntilRearmed) {
  Bench bench;
  bench.write(4);
  bench.script.read = {Code::disconnected, -1160};
  bench.read(0);
  bench.script.read = {};
  EXPECT_EQ(bench.write(4).code, Code::disconnected);
  EXPECT_EQ(bench.script.written.back(), 0);
  bench.script.calls.clear();
  bench.device.kick();
  EXPECT_TRUE(bench.script.calls.empty()) << "the watchdog is to expire";
  EXPECT_TRUE(bench.device.rearm().ok());
  EXPECT_TRUE(bench.write(4).ok());
  EXPECT_EQ(bench.script.written.back(), 4);
}

TEST(IoDevice, AStopSendsSafeValuesTwiceAndDisarmsOnlyWhatIsConfirmed) {
  Bench bench;
  bench.write(4);
  bench.script.calls.clear();
  EXPECT_EQ(bench.device.stop(), OutputsSafe::confirmed);
  EXPECT_EQ(bench.script.calls, (std::vector<std::string>{"write", "stop_sampling", "write", "disarm"}));
  EXPECT_EQ(bench.script.written.back(), 0);
}

TEST(IoDevice, AStopThatTheDeviceRefusesIsUnknownUnlessItsWatchdogActed) {
  Bench unplugged;
  unplugged.script.write = {Code::disconnected, -1160};
  EXPECT_EQ(unplugged.device.stop(), OutputsSafe::unknown);
  EXPECT_EQ(std::ranges::count(unplugged.script.calls, "disarm"), 0) << "the watchdog stays armed";
  Bench watched;
  watched.script.write = {Code::device_fault, -1202};
  watched.script.watchdog_took_over = true;
  EXPECT_EQ(watched.device.stop(), OutputsSafe::by_watchdog);
}

TEST(IoDevice, StopAndCloseMayComeInAnyStateAndAgain) {
  Script script;
  IoDevice device(device_of(), std::make_unique<ScriptedDriver>(script));
  device.stop();
  device.close();
  EXPECT_TRUE(script.calls.empty());
  device.open();
  device.close();
  EXPECT_EQ(script.calls, (std::vector<std::string>{"open", "close"}))
      << "nothing was written, nothing to make safe";
  device.open();
  device.preset();
  device.close();
  device.close();
  device.stop();
  EXPECT_EQ(script.written.back(), 0);
  EXPECT_EQ(std::ranges::count(script.calls, "close"), 2);
}

TEST(IoDevice, CallsBeforeTheirTimeAreRefused) {
  Script script;
  IoDevice device(device_of(), std::make_unique<ScriptedDriver>(script));
  Sample sample;
  EXPECT_EQ(device.read(sample, {}).code, Code::not_open);
  EXPECT_EQ(device.write(std::array{1.0}).code, Code::not_open);
  EXPECT_EQ(device.preset().code, Code::not_open);
  EXPECT_TRUE(script.calls.empty());
}

}  // namespace
}  // namespace loopwright::hw::io_device_test
