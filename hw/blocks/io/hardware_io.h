/// The block that replaces the plant: one axis of a device.
#pragma once
#include <memory>
#include "engine/block.h"
#include "hw/device/description.h"

namespace loopwright::blocks {

struct HardwareIo {
  static constexpr bool has_side_effects = true;
  std::string device_file, position_input, velocity_input, command_output;
  double position = 0, velocity = 0;  // as read; written by the loop before every step
  double period = 0;
  std::shared_ptr<const hw::DeviceDescription> device;
  int position_channel = -1, velocity_channel = -1, command_channel = -1;  // index among those of the device
  struct In {
    double command;
  };
  struct Out {
    double position, velocity;
  };
  struct Memory {
    double position, is_known;
  };
  static constexpr auto describe() {
    return block(
        "An axis of a real device, in the place of a simulated plant; without the device it stands still.",
        parameter(&HardwareIo::device_file, "device", "", "Device file, relative to the diagram").file(),
        parameter(&HardwareIo::position_input, "position_input", "",
                  "Input of the device that is the position; the first encoder when left out")
            .optional(),
        parameter(&HardwareIo::velocity_input, "velocity_input", "",
                  "Input of the device that is the velocity; the difference of positions when left out")
            .optional(),
        parameter(&HardwareIo::command_output, "command_output", "",
                  "Output of the device that the command goes to; the first when left out")
            .optional(),
        parameter(&HardwareIo::position, "position", "$position", "Where it stands without a device")
            .optional(),
        parameter(&HardwareIo::velocity, "velocity", "$position/s", "Its velocity without a device")
            .optional(),
        input(&In::command, "command", "$command", "To the device, within its limits"),
        output(&Out::position, "position", "$position", "As measured at this sample").from_memory(),
        output(&Out::velocity, "velocity", "$position/s", "Measured, or by the difference over a sample")
            .from_memory());
  }
  void check(const Checker& checker);
  /// The units of the channels.
  std::vector<UnitClaim> unit_claims() const;
  void prepare(double sample_time) { period = sample_time; }
  void outputs(const Memory& memory, Out& out) const {
    const bool by_difference = velocity_channel < 0 && memory.is_known > 0;
    out.position = position;
    out.velocity = by_difference ? (position - memory.position) / period : velocity;
  }
  void update(const In&, Memory& memory) const { memory = {position, 1}; }
};

}  // namespace loopwright::blocks
