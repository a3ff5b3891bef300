// What is refused of a diagram and its device before anything moves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "hw/realtime/axes.h"
#include "tests/engine/diagram/diagram_folder.h"
#include "tests/hw/device_file.h"

namespace loopwright::hw::axes_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string problems_of(const std::string& solver, const std::string& device_patch = "{}") {
  DiagramFolder folder;
  folder.with("device.json", device_text(device_patch));
  folder.with("top.json", R"({"loopwright": 1, "solver": )" + solver + R"(, "blocks": {
      "gain": {"type": "Gain", "gain": {"value": -20, "unit": "V/m"}, "in": {"u": "axis.position"}},
      "axis": {"type": "HardwareIo", "device": "device.json", "sample_time": 0.01, "in": {"command": "gain.y"}}}})");
  Problems problems;
  find_hardware(*load_plan(folder.path("top.json"), {}), problems);
  return problems.text();
}
const std::string patient = R"({"watchdog": {"timeout": 0.1}})";

TEST(Axes, AStartBetweenTwoSamplesIsRefused) {
  EXPECT_THAT(problems_of(R"({"start": 0.005, "stop": 1, "step": 0.001})", patient),
              AllOf(HasSubstr("a loop on hardware begins with a sample"), HasSubstr("0.005 s"),
                    HasSubstr("multiple of the sample_time of 0.01 s"), HasSubstr("top.json:1")));
  for (const char* start : {"0", "0.03"})
    EXPECT_EQ(problems_of(std::string(R"({"stop": 1, "step": 0.001, "start": )") + start + "}", patient), "");
}

TEST(Axes, AWatchdogThatExpiresBetweenTwoCommandsIsRefused) {
  const std::string solver = R"({"stop": 1, "step": 0.001})";
  EXPECT_THAT(problems_of(solver),  // 0.01 s, one period
              AllOf(HasSubstr("the watchdog would expire between two commands"), HasSubstr("device.json"),
                    HasSubstr("at least two periods of 0.01 s")));
  EXPECT_EQ(problems_of(solver, R"({"watchdog": {"timeout": 0.02}})"), "");
  EXPECT_EQ(problems_of(solver, R"({"watchdog": {"timeout": 0}})"), "")
      << "deploy asks whether that is accepted";
}

}  // namespace
}  // namespace loopwright::hw::axes_test
