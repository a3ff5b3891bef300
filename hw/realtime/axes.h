/// The hardware in a plan: the blocks that are axes of a device, and what they share.
#pragma once
#include "engine/plan/plan.h"
#include "hw/blocks/io/hardware_io.h"

namespace loopwright::hw {

struct Axis {
  int block = -1;
  std::string path;  ///< "stage"
  const blocks::HardwareIo* io = nullptr;
  Number command = -1;
};

/// All axes of a plan, and the single device and period that they share.
struct Hardware {
  std::shared_ptr<const DeviceDescription> device;
  std::vector<Axis> axes;
  int64_t period_ticks = 0;
  double period_s = 0;
};

/// Empty `axes`: the plan has no hardware. Problems: several devices or periods, a channel used twice, units
/// that differ from the device's, a start between two samples, a watchdog shorter than two periods, a solver
/// whose step is not known in advance.
Hardware find_hardware(const Plan& plan, Problems& problems);

}  // namespace loopwright::hw
