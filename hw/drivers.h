/// The kinds of hardware that there are.
#pragma once
#include "hw/device/driver.h"

namespace loopwright::hw {

struct DriverType {
  std::string_view name;  ///< "driver" in a device file
  std::string_view sentence;
  /// Problems of the driver's own part of the file; opens and loads nothing.
  void (*check)(const DeviceDescription& device, Problems& problems);
  /// The file of foreign code that `make` loads and runs, for a person to read before; empty: none.
  std::string (*foreign_code)(const DeviceDescription& device);
  /// What Driver::take_over does to whoever has the device, for a person who is to agree; null: it cannot.
  const char* taking_over;
  /// Ready to be opened; null after a problem.
  std::unique_ptr<Driver> (*make)(std::shared_ptr<const DeviceDescription> device, Problems& problems);
};

std::span<const DriverType> driver_types();
/// Null when there is none of the name.
const DriverType* find_driver(std::string_view name);

/// "device.json: its driver loads and runs the code of …", or empty. Loads nothing.
std::string foreign_code_of(const DeviceDescription& device);

/// A device file with everything checked that can be checked without the device; null after problems.
std::shared_ptr<const DeviceDescription> load_device(const std::string& path, const Place& reference,
                                                     Problems& problems);

}  // namespace loopwright::hw
