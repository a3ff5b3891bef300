/// The interface between a control loop and hardware: physical units, limits, latched faults, a safe stop.
///
///   open → preset → start → {read, write, kick}* → stop → close
///
/// 1. Setting up may allocate; read, write and kick are noexcept, bounded and allocate nothing.
/// 2. After a latched fault every write sends only the safe values, until rearm().
/// 3. A write is all or nothing. A value that is not finite is refused and latches a fault.
/// 4. stop() and close() may be called in any state and repeatedly.
/// 5. Whether the outputs are safe is confirmed or unknown, never assumed; before the first call that may
///    change them they are untouched.
/// 6. An implausible raw number is never used: it is a fault, or the previous value is held for a stated
///    number of samples. Nothing begins before two samples have agreed.
#pragma once
#include <atomic>
#include <functional>
#include "hw/device/driver.h"
#include "hw/device/explain.h"
#include "hw/device/input.h"

namespace loopwright::hw {

/// When a sample was taken, as far as the device reports it.
struct Sample {
  int64_t sequence = 0;
  int64_t lost = 0;      ///< missing numbers since the previous sample
  int32_t glitches = 0;  ///< inputs whose reading was refused
};

class IoDevice {
 public:
  IoDevice(std::shared_ptr<const DeviceDescription> description, std::unique_ptr<Driver> driver);
  ~IoDevice() { close(); }
  IoDevice(const IoDevice&) = delete;
  IoDevice& operator=(const IoDevice&) = delete;

  const DeviceDescription& description() const { return *description_; }
  Capabilities capabilities() const { return driver_->capabilities(); }
  std::vector<std::string> facts() const { return driver_->facts(); }
  std::string describe(Status status) const;

  /// `busy`: another program has opened the device, which was left untouched. An open device stays open.
  Status open();
  /// Ends the other program's use of the device and opens it. Its outputs are unknown until a stop.
  Status take_over();
  /// Encoder counts, ranges, safe outputs, watchdog values.
  Status preset();
  /// Begins to sample, arms the watchdog, then sends the initial values.
  Status start(double period_s);

  /// Values of all inputs, in the order of the description. On a fault the values are those of the last
  /// sample. If inputs have a maximum rate, the first read takes two or more samples, until two agree.
  Status read(Sample& sample, std::span<double> values) noexcept;
  /// Values of all outputs; clamped, and changed no faster than their maximum rate.
  Status write(std::span<const double> values) noexcept;
  Status kick() noexcept;
  /// From any thread or signal handler: the next read returns `stopped`.
  void request_stop() noexcept { driver_->request_stop(); }

  /// After a crash, from a thread that does not use the device otherwise: sends the safe values. After that
  /// nothing else is sent, whatever the loop writes.
  void emergency_stop() noexcept;
  /// The same in two parts, for who must not wait in a driver that may hang: first only the safe values are
  /// let through, then another thread makes the call.
  void allow_only_safe_values() noexcept { is_emergency_ = true; }
  std::function<void()> call_of_emergency_stop() const;
  std::function<void()> call_of_request_stop() const;

  /// Safe values, end of sampling, safe values again. The watchdog stays armed unless they were confirmed.
  OutputsSafe stop() noexcept;
  void close() noexcept;
  /// Clears a latched fault. Only between runs.
  Status rearm();

  Status fault() const { return fault_; }
  OutputsSafe outputs_safe() const { return outputs_safe_; }
  /// The values last sent, in physical units.
  std::span<const double> applied() const { return applied_; }
  int64_t clamped() const { return clamped_; }
  int64_t rate_limited() const { return rate_limited_; }
  int64_t glitches() const { return glitches_; }

 private:
  enum class Stage { closed, open, ready, running };
  Status latch(Status status) noexcept;
  Status opened(Status status);
  Status send_initial() noexcept;
  Status read_first(Sample& sample) noexcept;
  Status read_next(Sample& sample) noexcept;
  Status take_sample(Sample& sample) noexcept;
  Status refuse(size_t i, Reading reading) noexcept;
  bool may_hold(const Input& input, Reading reading) const noexcept;
  Status send(std::span<const double> raw) noexcept;
  bool send_safe() noexcept;

  std::shared_ptr<const DeviceDescription> description_;
  std::shared_ptr<Driver> driver_;  // also of calls that hang, and outlive the device
  Stage stage_ = Stage::closed;
  Status fault_;
  std::atomic<bool> is_emergency_ = false;
  OutputsSafe outputs_safe_ = OutputsSafe::untouched;
  bool has_written_ = false, is_stopped_ = false;
  double period_s_ = 0;
  std::vector<Input> inputs_;
  bool has_rates_ = false, has_begun_ = false;
  int64_t last_sequence_ = -1;
  Incident incident_;
  std::vector<double> raw_in_, raw_out_, raw_safe_, raw_initial_, applied_;
  int64_t clamped_ = 0, rate_limited_ = 0, glitches_ = 0;
};

}  // namespace loopwright::hw
