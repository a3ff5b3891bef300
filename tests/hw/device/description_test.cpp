// Errors in a device file are reported with source location, before anything can move.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "tests/hw/device_file.h"

namespace loopwright::hw {
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
  EXPECT_THAT(problems_of_device(device_text(R"({"inputs": {"position": {"unit": "um"}}})")),
              AllOf(HasSubstr("SI units"), HasSubstr("scale")));
}

TEST(DeviceFile, EveryProblemIsToldAtOnce) {
  const std::string text = problems_of_device(device_text(
      R"({"outputs": {"drive": {"safe": null}}, "clock": {"buffer": 0}, "inputs": {"position": {"scale": "x"}}})"));
  EXPECT_THAT(text, AllOf(HasSubstr("/outputs/drive"), HasSubstr("/clock/buffer"),
                          HasSubstr("/inputs/position/scale")));
}

}  // namespace
}  // namespace loopwright::hw
