/// What a kind of hardware has to offer: raw numbers in and out. Implement this to add one
/// (docs/hardware.md).
///
/// A driver knows the description, speaks counts and volts, and reports; units, limits, wraps, latching and
/// the order of a safe stop are the business of IoDevice, which is the same for all.
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
  bool has_watchdog = false;  ///< of its own, beyond this program
  bool detects_lost = false;  ///< tells when a sample was dropped
  bool reads_back = false;    ///< a write is answered, so that safe outputs can be confirmed
  /// emergency_stop() works while another thread hangs anywhere in the driver, with any lock held. False: it
  /// is tried, with a limit of time, and only the watchdog is certain.
  bool is_reentrant = false;
};

/// Facts that come with a sample.
struct RawSample {
  /// Counted by the device, one a period: where a number is missing, its sample was lost.
  int64_t sequence = 0;
};

class Driver {
 public:
  virtual ~Driver() = default;
  virtual Capabilities capabilities() const = 0;

  // Set-up: may allocate and take time.
  /// `busy`: another program has the device; then nothing of it was touched.
  virtual Status open() = 0;
  /// Ends what another program does with the device, and opens it. Only after a person has agreed.
  virtual Status take_over() { return {Code::unsupported}; }
  /// Ranges, encoder counts, initial outputs, watchdog states. `initial`, `safe`: raw, an output each.
  virtual Status configure(std::span<const double> initial, std::span<const double> safe) = 0;
  virtual Status start(double period_s) = 0;
  /// What went wrong with a status, in words; not in the loop.
  virtual std::string describe(Status status) const = 0;
  /// Lines for the report at the start: library, version, board.
  virtual std::vector<std::string> facts() const { return {}; }

  // The loop: bounded, no allocation, no lock.
  /// Raw numbers of all inputs. One that is not filled in stays NaN, and is refused as that.
  virtual Status read(RawSample& sample, std::span<double> raw) noexcept = 0;
  virtual Status write(std::span<const double> raw) noexcept = 0;
  /// A sign of life for the watchdog; the first one arms it.
  virtual Status kick() noexcept = 0;
  /// Ends a blocked read. Called from another thread; async-signal-safe.
  virtual void request_stop() noexcept = 0;
  /// After a crash of the process: puts out `safe` (raw, an output each) at once, with what is already open
  /// and resolved. Called in any state, from a thread that is not the loop's, while that may stand anywhere
  /// in this driver or be dead; in the worst case from a signal handler. So it allocates, locks and waits for
  /// nothing of its own.
  virtual void emergency_stop(std::span<const double> safe) noexcept = 0;

  // The end: every step is attempted, whatever failed before; may be called in any state, and again.
  /// Ends sampling; the outputs stay as they are.
  virtual void stop_sampling() noexcept = 0;
  /// After safe values were confirmed: further values on termination, and the watchdog off.
  virtual void disarm() noexcept = 0;
  /// Whether the watchdog has put out its own values; waits for it, at most its timeout.
  virtual bool watchdog_took_over() noexcept = 0;
  virtual void close() noexcept = 0;
  /// Leaves the protected mode after a fault.
  virtual Status rearm() = 0;
};

}  // namespace loopwright::hw
