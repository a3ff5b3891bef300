/// Cards accessed through the vendor's HIL library (QPIDe, Q8-USB, …).
#pragma once
#include "hw/device/driver.h"

namespace loopwright::hw::quanser {

/// "quanser" in a device file.
struct Settings {
  std::string board = "qpid_e";
  std::string identifier = "0";
  std::string library;     ///< empty: the usual folders
  int clock = 0;           ///< hardware clock that triggers the samples
  int analog_outputs = 8;  ///< of the card: each one gets a watchdog state
  std::string options;     ///< in the vendor's syntax, "enc0_filter=1;…"
  static constexpr auto describe() {
    return fields(
        parameter(&Settings::board, "board", "", "The vendor's name of the card").optional(),
        parameter(&Settings::identifier, "identifier", "", "Which card: \"0\" is the first").optional(),
        parameter(&Settings::library, "library", "", "The vendor's library; the usual places when left out")
            .optional(),
        parameter(&Settings::clock, "clock", "", "Hardware clock of the samples").between(0, 16).optional(),
        parameter(&Settings::analog_outputs, "analog_outputs", "", "How many the card has")
            .between(0, 8)
            .optional(),
        parameter(&Settings::options, "options", "",
                  "Options of the card: name=value, separated by semicolons")
            .optional());
  }
};

/// Reads the driver's part of a device file and checks it against the rules of the card; loads nothing.
Settings read_settings(const DeviceDescription& device, Problems& problems);

/// The library that make_driver loads, and what selected it.
std::string foreign_code(const DeviceDescription& device);

/// For the person who must agree to Driver::take_over.
inline constexpr const char* what_taking_over_does =
    "Taking it over closes every card that the vendor's library has open, under whatever program drives it: "
    "that "
    "program's loop ends in the middle of its motion, and the outputs stay where they were until this "
    "program "
    "sends its own safe values. What the vendor's library does to programs in other processes is not "
    "known.";

/// Loads the library; null after a problem. Opens no card.
std::unique_ptr<Driver> make_driver(std::shared_ptr<const DeviceDescription> device, Problems& problems);

}  // namespace loopwright::hw::quanser
