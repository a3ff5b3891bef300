/// Devices connected by UDP: a microcontroller, a rapid-control computer, another program. An example of how
/// to add hardware (docs/hardware.md).
#pragma once
#include "hw/device/driver.h"

namespace loopwright::hw::udp {

/// "udp" in a device file.
struct Settings {
  std::string address = "127.0.0.1";
  int port = 0;
  double patience = 0.1;
  static constexpr auto describe() {
    return fields(parameter(&Settings::address, "address", "", "IPv4 address of the device").optional(),
                  parameter(&Settings::port, "port", "", "Its port").between(1, 65535),
                  parameter(&Settings::patience, "patience", "s", "Without an answer for so long, it is gone")
                      .between(1e-3, 3600)
                      .optional());
  }
};

Settings read_settings(const DeviceDescription& device, Problems& problems);
std::unique_ptr<Driver> make_driver(std::shared_ptr<const DeviceDescription> device, Problems& problems);

}  // namespace loopwright::hw::udp
