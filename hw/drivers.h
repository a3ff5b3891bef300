/// The available kinds of hardware.
#pragma once
#include "engine/json/file_shape.h"
#include "hw/device/driver.h"

namespace loopwright::hw {

struct DriverType {
  std::string_view name;  ///< "driver" in a device file
  std::string_view sentence;
  /// Its part of the file, an object under its name.
  std::vector<ParameterInfo> (*settings)();
  /// Checks the driver's part of the file; opens and loads nothing.
  void (*check)(const DeviceDescription& device, Problems& problems);
  /// The file of foreign code that `make` loads and runs, shown to a person beforehand; empty: none.
  std::string (*foreign_code)(const DeviceDescription& device);
  /// What Driver::take_over does to the device's present user, for the person who must agree; null:
  /// unsupported.
  const char* taking_over;
  /// Ready to be opened; null after a problem.
  std::unique_ptr<Driver> (*make)(std::shared_ptr<const DeviceDescription> device, Problems& problems);
};

std::span<const DriverType> driver_types();

/// The keys of device files, with the settings of all drivers.
FileShape device_file_shape();

/// Null when no driver has the name.
const DriverType* find_driver(std::string_view name);

/// "device.json: its driver loads and runs the code of …", or empty. Loads nothing.
std::string foreign_code_of(const DeviceDescription& device);

/// A device file, with everything checked that can be checked without the device; null after problems.
std::shared_ptr<const DeviceDescription> load_device(const std::string& path, const Place& reference,
                                                     Problems& problems);

}  // namespace loopwright::hw
