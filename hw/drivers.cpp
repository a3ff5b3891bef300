#include "hw/drivers.h"
#include <fmt/format.h>
#include <algorithm>
#include "engine/block/parameter_shape.h"
#include "hw/device/device_shape.h"
#include "hw/quanser/quanser.h"
#include "hw/udp/udp.h"

namespace loopwright::hw {
namespace {

// To add hardware: add a folder with a Driver, and a line here.
const DriverType types[] = {
    {"quanser", "Cards behind Quanser's HIL library", &parameters_of<quanser::Settings>,
     [](const DeviceDescription& device, Problems& problems) { quanser::read_settings(device, problems); },
     &quanser::foreign_code, quanser::what_taking_over_does, &quanser::make_driver},
    {"udp", "Devices that speak UDP", &parameters_of<udp::Settings>,
     [](const DeviceDescription& device, Problems& problems) { udp::read_settings(device, problems); },
     [](const DeviceDescription&) { return std::string(); }, nullptr, &udp::make_driver},
};

}  // namespace

std::span<const DriverType> driver_types() { return types; }

FileShape device_file_shape() {
  std::vector<std::pair<std::string_view, FileShape>> drivers;
  for (const DriverType& type : types)
    drivers.emplace_back(type.name, shape_of(type.settings(), Writing::evaluated));
  return device_shape(drivers);
}

const DriverType* find_driver(std::string_view name) {
  const auto found = std::ranges::find(types, name, &DriverType::name);
  return found == std::end(types) ? nullptr : found;
}

std::string foreign_code_of(const DeviceDescription& device) {
  const DriverType* driver = find_driver(device.driver);
  const std::string code = driver ? driver->foreign_code(device) : "";
  return code.empty() ? code : fmt::format("{}: its driver loads and runs the code of {}", device.path, code);
}

std::shared_ptr<const DeviceDescription> load_device(const std::string& path, const Place& reference,
                                                     Problems& problems) {
  Problems own;
  std::vector<std::string> names;
  for (const DriverType& type : types) names.emplace_back(type.name);
  const auto device = read_device(path, reference, names, own);
  if (device) find_driver(device->driver)->check(*device, own);
  problems.add(own);
  return own.has_errors() ? nullptr : device;
}

}  // namespace loopwright::hw
