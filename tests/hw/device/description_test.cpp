// Errors in a device file are reported with source location, before anything can move.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <numbers>
#include "tests/hw/device_file.h"

namespace loopwright::hw::description_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(DeviceFile, TheOneOfTheQpidIsFine) {
  const auto device = device_of();
  ASSERT_TRUE(device);
  EXPECT_EQ(device->inputs.at(0).scale, 2e-7);
  EXPECT_EQ(device->outputs.at(0).safe, 0);
  EXPECT_EQ(device->watchdog.timeout, 0.01);
}

TEST(DeviceFile, AMissingSafeValueIsAnError) {
  EXPECT_THAT(
      problems_of_device(device_text(R"({"outputs": {"drive": {"safe": null}}})")),
      AllOf(HasSubstr("device.json:"), HasSubstr("/outputs/drive"), HasSubstr("\"safe\" is missing")));
}

TEST(DeviceFile, AChannelTakenTwiceIsAnError) {
  EXPECT_THAT(problems_of_device(device_text(
                  R"({"inputs": {"second": {"kind": "encoder", "channel": 0, "unit": "m", "scale": 1}}})")),
              AllOf(HasSubstr("/inputs/second/channel"), HasSubstr("taken twice"), HasSubstr("position")));
}

TEST(DeviceFile, ValuesBeyondTheRangeAreErrors) {
  EXPECT_THAT(problems_of_device(device_text(R"({"outputs": {"drive": {"safe": 11}}})")),
              AllOf(HasSubstr("/outputs/drive/safe"), HasSubstr("from -10 to 10 V"), HasSubstr("11 V")));
  EXPECT_THAT(problems_of_device(device_text(R"({"outputs": {"drive": {"maximum": 2, "initial": 3}}})")),
              HasSubstr("/outputs/drive/initial"));
  EXPECT_THAT(problems_of_device(device_text(R"({"inputs": {"position": {"preset": 9000000}}})")),
              HasSubstr("/inputs/position/preset"));
  EXPECT_THAT(problems_of_device(device_text(R"({"watchdog": {"timeout": 0.5}})")), HasSubstr("0.419 s"));
  EXPECT_THAT(problems_of_device(device_text(R"({"outputs": {"drive": {"channel": 8}}})")),
              HasSubstr("no such channel"));
}

TEST(DeviceFile, AnOutputThatTheWatchdogDoesNotCoverIsAnError) {
  EXPECT_THAT(problems_of_device(
                  device_text(R"({"quanser": {"analog_outputs": 2}, "outputs": {"drive": {"channel": 5}}})")),
              AllOf(HasSubstr("/quanser/analog_outputs"), HasSubstr("drive"),
                    HasSubstr("the card's watchdog would not put out the safe value of this output"),
                    HasSubstr("channel 5, and \"analog_outputs\": 2")));
  EXPECT_THAT(problems_of_device(device_text(R"({"quanser": {"board": "other", "analog_outputs": 0}})")),
              HasSubstr("channel 0, and \"analog_outputs\": 0"));
  EXPECT_EQ(problems_of_device(
                device_text(R"({"quanser": {"analog_outputs": 6}, "outputs": {"drive": {"channel": 5}}})")),
            "");
}

TEST(DeviceFile, UnknownNamesAreErrorsWithWhatWasMeant) {
  EXPECT_THAT(problems_of_device(device_text(R"({"quanser": {"options": "enc0_fliter=1;latch_on_adc=1"}})")),
              AllOf(HasSubstr("enc0_fliter"), HasSubstr("did you mean \"enc0_filter\"")));
  EXPECT_THAT(problems_of_device(device_text(R"({"outputs": {"drive": {"sacle": 1}}})")),
              HasSubstr("did you mean \"scale\""));
  EXPECT_THAT(problems_of_device(device_text(R"({"driver": "quaner"})")),
              HasSubstr("did you mean \"quanser\""));
  EXPECT_THAT(problems_of_device(device_text(R"({"policy": {"on_overrun": "ignore"}})")),
              HasSubstr("\"fault\" or \"count\""));
}

TEST(DeviceFile, UnitsWithPrefixesAreErrors) {
  for (const char* unit : {"um", "degC"})
    EXPECT_THAT(problems_of_device(
                    device_text(fmt::format(R"({{"inputs": {{"position": {{"unit": "{}"}}}}}})", unit))),
                AllOf(HasSubstr("SI units"), HasSubstr("scale")));
}

TEST(DeviceFile, NumbersWithUnitsAreConverted) {
  const auto device = device_of(R"({
    "inputs": {"position": {"scale": {"value": 0.2, "unit": "um"}, "offset": {"value": 5, "unit": "mm"},
                            "maximum_rate": {"value": 3000, "unit": "mm/s"}, "filter": {"value": 1, "unit": "MHz"}},
               "speed": {"kind": "encoder_velocity", "channel": 1, "unit": "m/s",
                         "scale": {"value": 0.2, "unit": "um"}},
               "angle": {"kind": "analog", "channel": 1, "unit": "rad", "scale": {"value": 180, "unit": "deg/V"},
                         "low": {"value": -5000, "unit": "mV"}}},
    "outputs": {"drive": {"unit": "A", "scale": {"value": 0.5, "unit": "A/V"}, "safe": {"value": 100, "unit": "mA"},
                          "initial": {"value": 200, "unit": "mA"}, "maximum": {"value": 500, "unit": "mA"},
                          "maximum_rate": {"value": 2, "unit": "A/ms"}, "high": {"value": 9000, "unit": "mV"}}},
    "watchdog": {"timeout": {"value": 20, "unit": "ms"}}})");
  ASSERT_TRUE(device);
  const InputChannel &position = device->inputs.at(0), &speed = device->inputs.at(1),
                     &angle = device->inputs.at(2);
  const OutputChannel& drive = device->outputs.at(0);
  EXPECT_DOUBLE_EQ(position.scale, 2e-7);
  EXPECT_DOUBLE_EQ(position.offset, 5e-3);
  EXPECT_DOUBLE_EQ(position.maximum_rate, 3);
  EXPECT_DOUBLE_EQ(position.filter, 1e6);
  EXPECT_DOUBLE_EQ(speed.scale, 2e-7);
  EXPECT_DOUBLE_EQ(angle.scale, std::numbers::pi);
  EXPECT_DOUBLE_EQ(angle.low, -5);
  EXPECT_DOUBLE_EQ(drive.scale, 0.5);
  EXPECT_DOUBLE_EQ(drive.safe, 0.1);
  EXPECT_DOUBLE_EQ(drive.initial, 0.2);
  EXPECT_DOUBLE_EQ(drive.maximum, 0.5);
  EXPECT_DOUBLE_EQ(drive.maximum_rate, 2000);
  EXPECT_DOUBLE_EQ(drive.high, 9);
  EXPECT_DOUBLE_EQ(device->watchdog.timeout, 0.02);
}

TEST(DeviceFile, RatesPerMinuteAreNoRadiansPerSecond) {
  const auto problems = [](const std::string& unit) {
    return problems_of_device(device_text(fmt::format(
        R"({{"outputs": {{"drive": {{"unit": "rad/s", "scale": 1, "maximum": {{"value": 60, "unit": "{}"}}}}}}}})",
        unit)));
  };
  EXPECT_THAT(problems("1/min"), AllOf(HasSubstr("60 1/min can mean two numbers"), HasSubstr("write rpm")));
  EXPECT_EQ(problems("rpm"), "");
}

TEST(DeviceFile, UnitsOfAnotherDimensionAreErrorsThatNameBoth) {
  const struct {
    std::string patch, pointer, expected, found;
  } cases[] = {
      {R"({"outputs": {"drive": {"unit": "A", "scale": {"value": 0.5, "unit": "V/A"}}}})",
       "/outputs/drive/scale", "a number in A/V", "0.5 "},
      {R"({"outputs": {"drive": {"unit": "A", "safe": {"value": 100, "unit": "mV"}}}})",
       "/outputs/drive/safe", "a number in A", "0.1 V"},
      {R"({"outputs": {"drive": {"unit": "A", "initial": {"value": 100, "unit": "mV"}}}})",
       "/outputs/drive/initial", "a number in A", "0.1 V"},
      {R"({"outputs": {"drive": {"unit": "A", "minimum": "=-500 mV"}}})", "/outputs/drive/minimum", "", ""},
      {R"({"outputs": {"drive": {"unit": "A", "maximum": {"value": 500, "unit": "mV"}}}})",
       "/outputs/drive/maximum", "a number in A", "0.5 V"},
      {R"({"outputs": {"drive": {"maximum_rate": {"value": 5, "unit": "V"}}}})",
       "/outputs/drive/maximum_rate", "a number in V/s", "5 V"},
      {R"({"outputs": {"drive": {"high": {"value": 5, "unit": "A"}}}})", "/outputs/drive/high",
       "a number in V", "5 A"},
      {R"({"outputs": {"drive": {"channel": {"value": 0, "unit": "V"}}}})", "/outputs/drive/channel",
       "a number without a unit", "0 V"},
      {R"({"inputs": {"position": {"scale": {"value": 2e-7, "unit": "m/V"}}}})", "/inputs/position/scale",
       "a number in m", "m"},
      {R"({"inputs": {"position": {"offset": {"value": 5, "unit": "deg"}}}})", "/inputs/position/offset",
       "a number in m", "rad"},
      {R"({"inputs": {"position": {"filter": {"value": 5, "unit": "s"}}}})", "/inputs/position/filter",
       "a number in Hz", "5 s"},
      {R"({"watchdog": {"timeout": {"value": 0.1, "unit": "Hz"}}})", "/watchdog/timeout", "a number in s",
       "0.1 Hz"},
      {R"({"clock": {"buffer": {"value": 2, "unit": "s"}}})", "/clock/buffer", "a number without a unit",
       "2 s"},
      {R"({"policy": {"most_lost": {"value": 3, "unit": "ms"}}})", "/policy/most_lost",
       "a number without a unit", "0.003 s"},
      {R"({"quanser": {"clock": {"value": 0, "unit": "m"}}})", "/quanser/clock", "a number without a unit",
       "0 m"},
  };
  for (const auto& [patch, pointer, expected, found] : cases)
    EXPECT_THAT(problems_of_device(device_text(patch)),
                AllOf(HasSubstr(pointer), HasSubstr(expected), HasSubstr(found)))
        << patch;
}

TEST(DeviceFile, EveryProblemIsToldAtOnce) {
  const std::string text = problems_of_device(device_text(
      R"({"outputs": {"drive": {"safe": null}}, "clock": {"buffer": 0}, "inputs": {"position": {"scale": "x"}}})"));
  EXPECT_THAT(text, AllOf(HasSubstr("/outputs/drive"), HasSubstr("/clock/buffer"),
                          HasSubstr("/inputs/position/scale")));
}

}  // namespace
}  // namespace loopwright::hw::description_test
