// Without a device: the block keeps its configured position, and its device file is checked. On a device:
// tests/hw/realtime.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"
#include "where.h"

namespace loopwright::hardware_io_test {
namespace {

const std::string device = R"("device": ")" LOOPWRIGHT_SOURCE R"(/hw/devices/qpid_e.json")";

TEST(HardwareIo, StandsStillWithoutADevice) {
  BlockUnderTest io("HardwareIo", "{" + device + R"(, "position": 0.25})", 0.001);
  ASSERT_FALSE(io.problems().has_errors()) << io.problems().text();
  io.input("command") = 5;
  for (int i = 0; i < 3; ++i) {
    io.evaluate(0.001 * i, i);
    io.update();
    EXPECT_EQ(io.output("position"), 0.25);
    EXPECT_EQ(io.output("velocity"), 0);
  }
}

TEST(HardwareIo, TheVelocityIsTheDifferenceOverASample) {
  BlockUnderTest io("HardwareIo", "{" + device + R"(, "position": 0.25})", 0.001);
  io.evaluate();
  const auto first = io.snapshot();
  io.update();
  const auto second = io.snapshot();
  EXPECT_FALSE(first == second);
  io.tune("position", 0.252);
  io.restore(second);
  io.evaluate(0.001, 1);
  EXPECT_NEAR(io.output("velocity"), 2, 1e-9);
}

TEST(HardwareIo, NamesTheChannelsThatTheDeviceHas) {
  BlockUnderTest wrong("HardwareIo",
                       "{" + device + R"(, "command_output": "drvie", "velocity_input": "tacho"})", 0.001);
  EXPECT_THAT(wrong.problems().text(), testing::AllOf(testing::HasSubstr("did you mean \"drive\""),
                                                      testing::HasSubstr("no channel \"tacho\"")));
  BlockUnderTest missing("HardwareIo", R"({"device": "nowhere.json"})", 0.001);
  EXPECT_THAT(missing.problems().text(), testing::HasSubstr("the device file cannot be used"));
}

}  // namespace
}  // namespace loopwright::hardware_io_test
