/// What the message of a crash says about the device and the log. All texts are made before.
#pragma once
#include <array>
#include <string>
#include "hw/device/io_device.h"

namespace loopwright::hw {

class LastWords {
 public:
  /// `journal`: path of the log that grows; empty: there is none.
  LastWords(const std::string& journal, bool has_watchdog);

  /// After a stop that came to its end. The journal is named if it is still there.
  const char* of(OutputsSafe safe) const noexcept;
  /// For a stop that does not come to its end, by how far the deployment has come.
  static const char* before_anything_is_sent() noexcept;
  static const char* before_sampling() noexcept;
  const char* while_sampling() const noexcept;
  static const char* after_the_stop() noexcept;

 private:
  std::string journal_;
  bool has_watchdog_;
  std::array<std::string, 4> with_log_;  // indexed by OutputsSafe
};

}  // namespace loopwright::hw
