/// Packets to and from a UDP device: fixed layout, little-endian, one channel list in each direction.
///
///   configure  → the device stores safe values and timeout         ← sample with sequence 0
///   start      → a sample every period, numbered from 1            ← sample, sample, …
///   command    → outputs, and reload of its watchdog
///   stop       → no more samples; commands are still answered      ← sample for every command from then on
///
/// Every packet to the device has a number; every sample contains the last number that took effect.
#pragma once
#include <cstdint>

namespace loopwright::hw::udp {

constexpr int most_channels = 32;
constexpr uint32_t to_device = 0x3143574c, from_device = 0x3153574c;  // "LWC1", "LWS1"

enum class Request : uint32_t { configure = 1, start = 2, command = 3, stop = 4, clear = 5 };
enum class DeviceState : uint32_t { fine = 0, watchdog_expired = 1, fault = 2 };

struct ToDevice {
  uint32_t magic = to_device;
  uint32_t number = 0;
  Request request = Request::command;
  uint32_t channels = 0;
  double period_s = 0;             ///< of start
  double timeout_s = 0;            ///< of configure; 0: no watchdog
  double raw[most_channels] = {};  ///< outputs; with configure: the safe ones
};

struct FromDevice {
  uint32_t magic = from_device;
  uint32_t sequence = 0;
  uint32_t answered = 0;  ///< number of the last packet that took effect
  DeviceState state = DeviceState::fine;
  uint32_t channels = 0;
  uint32_t unused = 0;
  double raw[most_channels] = {};
};

}  // namespace loopwright::hw::udp
