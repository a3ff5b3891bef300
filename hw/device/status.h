/// Result of a call to a device, and what is known of its outputs.
#pragma once
#include <cstdint>
#include <string_view>

namespace loopwright::hw {

/// Codes from `watchdog` on latch: only safe values are sent until rearm().
enum class Code : uint8_t {
  ok,
  stopped,  ///< the device was asked to stop, or its task ended
  late,     ///< the sample arrived after its deadline
  lost,     ///< more consecutive samples are missing than the policy allows
  range,    ///< a number out of range was refused
  watchdog,
  device_fault,
  disconnected,
  unsupported,
  config_error,
  not_open,
  busy,
  no_driver,
};
constexpr bool latches(Code code) { return code >= Code::watchdog; }
std::string_view to_name(Code code);

struct Status {
  Code code = Code::ok;
  int32_t native = 0;  ///< the device's own code, for messages
  bool ok() const { return code == Code::ok; }
};

/// What is known of the outputs after a stop: never assumed.
enum class OutputsSafe : uint8_t {
  confirmed,    ///< the device accepted the safe values
  by_watchdog,  ///< the device's watchdog has output its own
  unknown,
  untouched  ///< nothing was sent to the device: its outputs are as another program, or nobody, left them
};
std::string_view to_name(OutputsSafe safe);

}  // namespace loopwright::hw
