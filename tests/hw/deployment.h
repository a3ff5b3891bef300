/// A deployment on the emulated card: diagram, device file, and results.
#pragma once
#include "hw/realtime/deploy.h"
#include "tests/hw/device_file.h"
#include "tests/hw/emulated_card.h"
#include "where.h"

namespace loopwright::hw {

/// The time of the emulated card.
class EmulatedTime final : public Clock {
 public:
  explicit EmulatedTime(const EmulatedCard& card) : card_(card) {}
  int64_t now_ns() noexcept override { return std::llround(1e9 * card_.get("time")); }
  void sleep_until(int64_t) noexcept override {}

 private:
  const EmulatedCard& card_;
};

/// The paper's loop with its stage on a device: hw/devices/qpid_e.json with a merge patch.
class Deployed {
 public:
  explicit Deployed(const std::string& device_patch = "{}", LoadOptions options = {},
                    const std::string& diagram = LOOPWRIGHT_SOURCE
                    "/diagrams/linear_motor/conventional.json") {
    folder_.with("device.json", device_text(device_patch));
    options.variants["stage"] = "quanser";
    options.set.emplace_back("stage.device", folder_.path("device.json"));
    plan = load_plan(diagram, options);
    Problems problems;
    hardware = find_hardware(*plan, problems);
    EXPECT_EQ(problems.text(), "");
    auto driver = find_driver(hardware.device->driver)->make(hardware.device, problems);
    EXPECT_EQ(problems.text(), "");
    device = std::make_unique<IoDevice>(hardware.device, std::move(driver));
  }
  DeployResult run(DeployOptions options = {}) { return deploy(*plan, hardware, *device, options); }

  std::shared_ptr<const Plan> plan;
  Hardware hardware;
  std::unique_ptr<IoDevice> device;

 private:
  DiagramFolder folder_;
};

/// The device's time differs from the computer's.
inline const std::string in_virtual_time = R"({"clock": {"time": "simulated"}})";

inline const std::vector<double>& column(const Recording& recording, std::string_view name) {
  const Column* found = recording.find(name);
  if (!found) throw std::invalid_argument("no column " + std::string(name));
  return found->values;
}

}  // namespace loopwright::hw
