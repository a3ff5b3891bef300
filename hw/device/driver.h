/// Interface of a kind of hardware: raw numbers in and out. Implement it to add hardware (docs/hardware.md).
///
/// A driver knows the description, works in counts and volts, and reports errors. Units, limits, wraps,
/// latching and the order of a safe stop are handled by IoDevice, which is the same for all drivers.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>
#include "hw/device/description.h"
#include "hw/device/status.h"

namespace loopwright::hw {

struct Capabilities {
  bool is_clock = false;      ///< read() waits for the device's next sample
  bool has_watchdog = false;  ///< independent of this program
  bool detects_lost = false;  ///< reports dropped samples
  bool reads_back = false;    ///< a write is acknowledged, so that safe outputs can be confirmed
  /// emergency_stop() works while another thread hangs anywhere in the driver, with any lock held. False: it
  /// is tried with a time limit, and only the watchdog is certain.
  bool is_reentrant = false;
  double longest_wait = 0;  ///< s that a call waits for a device that does not answer
};

/// Facts that accompany a sample.
struct RawSample {
  /// Counted by the device, one per period. A missing number is a lost sample.
  int64_t sequence = 0;
};

class Driver {
 public:
  virtual ~Driver() = default;
  virtual Capabilities capabilities() const = 0;

  // Set-up: may allocate and take time.
  /// `busy`: another program has opened the device; the device was left untouched.
  virtual Status open() = 0;
  /// Ends the other program's use of the device and opens it. Only after a person has agreed.
  virtual Status take_over() { return {Code::unsupported}; }
  /// Ranges, encoder counts, watchdog states, and `safe` (raw, one number per output) as the first outputs:
  /// the watchdog is not armed yet.
  virtual Status configure(std::span<const double> safe) = 0;
  virtual Status start(double period_s) = 0;
  /// Describes the error of a status. Not called in the loop.
  virtual std::string describe(Status status) const = 0;
  /// Lines for the report at the start: library, version, board.
  virtual std::vector<std::string> facts() const { return {}; }

  // The loop: bounded, no allocation, no lock.
  /// Raw numbers of all inputs. An input that is not filled in stays NaN and is refused as NaN.
  virtual Status read(RawSample& sample, std::span<double> raw) noexcept = 0;
  virtual Status write(std::span<const double> raw) noexcept = 0;
  /// Reloads the watchdog; the first call arms it.
  virtual Status kick() noexcept = 0;
  /// Ends a blocked read. Called from another thread; async-signal-safe.
  virtual void request_stop() noexcept = 0;
  /// After a crash of the process, or while a call hangs: outputs `safe` (raw, one number per output) at
  /// once, using only what is already open and resolved. Called in any state, from a thread other than the
  /// loop's thread, which may be anywhere in this driver or dead; in the worst case from a signal handler. So
  /// it allocates nothing, takes no lock and waits for nothing of its own.
  virtual void emergency_stop(std::span<const double> safe) noexcept = 0;

  // The end: every step is attempted, even after earlier failures. May be called in any state and repeatedly.
  /// Ends sampling; the outputs keep their values.
  virtual void stop_sampling() noexcept = 0;
  /// After safe values were confirmed: sets the values on termination, and turns the watchdog off.
  virtual void disarm() noexcept = 0;
  /// Whether the watchdog has output its own values. Waits at most the watchdog's timeout.
  virtual bool watchdog_took_over() noexcept = 0;
  virtual void close() noexcept = 0;
  /// Leaves the protected mode after a fault.
  virtual Status rearm() = 0;
};

}  // namespace loopwright::hw
