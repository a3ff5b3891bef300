#include "hw/device/io_device.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace loopwright::hw {
namespace {
constexpr int most_glitches = 3;  // in a row: then it is no glitch but a broken sensor
}

std::string_view to_name(Code code) {
  static constexpr std::string_view names[] = {"ok",           "stopped",      "late",         "range",
                                               "watchdog",     "device_fault", "disconnected", "unsupported",
                                               "config_error", "not_open",     "busy",         "no_driver"};
  return names[size_t(code)];
}
std::string_view to_name(OutputsSafe safe) {
  static constexpr std::string_view names[] = {"confirmed", "by_watchdog", "unknown"};
  return names[size_t(safe)];
}

IoDevice::IoDevice(std::shared_ptr<const DeviceDescription> description, std::unique_ptr<Driver> driver)
    : description_(std::move(description)), driver_(std::move(driver)) {
  inputs_.resize(description_->inputs.size());
  raw_in_.resize(inputs_.size());
  for (const OutputChannel& output : description_->outputs) {
    raw_safe_.push_back(output.volts(output.safe));
    applied_.push_back(output.initial);
  }
  raw_out_ = raw_safe_;
}

std::string IoDevice::describe(Status status) const {
  if (status.code == Code::range && status.native == 0) return "a value to put out is not a finite number";
  const std::string text = driver_->describe(status);
  return fmt::format("{}{}{}", to_name(status.code), text.empty() ? "" : ": ", text);
}

Status IoDevice::latch(Status status) noexcept {
  if (latches(status.code) && !latches(fault_.code)) fault_ = status;
  return status;
}

Status IoDevice::open() {
  if (stage_ != Stage::closed) return {Code::busy};
  const Status status = driver_->open();
  if (status.ok()) stage_ = Stage::open;
  return status;
}

Status IoDevice::preset() {
  if (stage_ != Stage::open) return {Code::not_open};
  std::vector<double> initial;
  for (const OutputChannel& output : description_->outputs) initial.push_back(output.volts(output.initial));
  has_written_ = true, is_stopped_ = false;  // even where it fails half way
  outputs_safe_ = OutputsSafe::unknown;
  const Status status = driver_->configure(initial, raw_safe_);
  if (!status.ok()) return latch(status);
  stage_ = Stage::ready;
  return status;
}

Status IoDevice::start(double period_s) {
  if (stage_ != Stage::ready) return {Code::not_open};
  period_s_ = period_s;
  for (InputState& input : inputs_) input = {};
  const Status status = driver_->start(period_s);
  if (!status.ok()) return latch(status);
  stage_ = Stage::running;
  return status;
}

/// Raw to physical: counts are unwrapped by differences modulo the counter's width. False: a glitch, held.
bool IoDevice::take_input(size_t i) noexcept {
  const InputChannel& channel = description_->inputs[i];
  InputState& state = inputs_[i];
  double raw = raw_in_[i];
  int64_t counts = 0;
  int32_t read = 0;
  if (channel.kind == InputKind::encoder) {
    read = int32_t(raw);
    const int unused = 32 - channel.counter_bits;
    const auto difference = int32_t((uint32_t(read) - uint32_t(state.last_counts)) << unused) >> unused;
    counts = state.is_known ? state.counts + difference : read;
    raw = double(counts);
  }
  const double value = channel.scale * raw + channel.offset;
  const double most = channel.maximum_rate * period_s_ * (1 + state.glitches_in_row);
  const bool jumps = state.is_known && channel.maximum_rate > 0 && std::abs(value - state.value) > most;
  if (jumps || !std::isfinite(value)) {
    ++glitches_, ++state.glitches_in_row;
    return false;
  }
  state.last_counts = read, state.counts = counts, state.value = value;
  state.glitches_in_row = 0, state.is_known = true;
  return true;
}

Status IoDevice::read(Sample& sample, std::span<double> values) noexcept {
  if (stage_ != Stage::running) return {Code::not_open};
  RawSample raw;
  const Status status = driver_->read(raw, raw_in_);
  sample = {raw.sequence, raw.lost, 0};
  bool is_broken = false;
  if (status.ok())
    for (size_t i = 0; i < inputs_.size(); ++i)
      if (!take_input(i)) {
        ++sample.glitches;
        is_broken |= inputs_[i].glitches_in_row >= most_glitches;
      }
  for (size_t i = 0; i < std::min(values.size(), inputs_.size()); ++i) values[i] = inputs_[i].value;
  if (is_broken) return latch({Code::device_fault, 0});
  return latch(status);
}

Status IoDevice::write(std::span<const double> values) noexcept {
  if (stage_ == Stage::closed) return {Code::not_open};
  if (latches(fault_.code)) {
    send_safe();
    return fault_;
  }
  if (values.size() != applied_.size() ||
      !std::ranges::all_of(values, [](double v) { return std::isfinite(v); })) {
    latch({Code::device_fault, 0});
    send_safe();
    return {Code::range};
  }
  has_written_ = true, is_stopped_ = false, outputs_safe_ = OutputsSafe::unknown;
  for (size_t i = 0; i < values.size(); ++i) {
    const OutputChannel& output = description_->outputs[i];
    double value = std::clamp(values[i], output.least(), output.greatest());
    clamped_ += value != values[i];
    if (const double step = output.maximum_rate * period_s_; step > 0) {
      const double limited = std::clamp(value, applied_[i] - step, applied_[i] + step);
      rate_limited_ += limited != value;
      value = limited;
    }
    applied_[i] = value;
    raw_out_[i] = output.volts(value);
  }
  return latch(send(raw_out_));
}

/// A value that was on its way when the emergency came must not be the last one.
Status IoDevice::send(std::span<const double> raw) noexcept {
  const Status status = driver_->write(is_emergency_ ? raw_safe_ : raw);
  return is_emergency_ ? driver_->write(raw_safe_) : status;
}

void IoDevice::emergency_stop() noexcept {
  is_emergency_ = true;
  driver_->emergency_stop(raw_safe_);
}

Status IoDevice::kick() noexcept {
  if (stage_ != Stage::running) return {Code::not_open};
  if (latches(fault_.code)) return fault_;  // the watchdog is to expire
  return latch(driver_->kick());
}

bool IoDevice::send_safe() noexcept {
  if (raw_safe_.empty()) return true;
  for (size_t i = 0; i < applied_.size(); ++i) applied_[i] = description_->outputs[i].safe;
  return driver_->write(raw_safe_).ok();
}

Status IoDevice::safe_outputs() noexcept {
  if (stage_ == Stage::closed) return {Code::not_open};
  const bool sent = send_safe();
  outputs_safe_ = sent ? OutputsSafe::confirmed : OutputsSafe::unknown;
  return sent ? Status{} : Status{Code::device_fault};
}

OutputsSafe IoDevice::stop() noexcept {
  if (stage_ == Stage::closed) return outputs_safe_;
  const bool before = send_safe();
  if (stage_ == Stage::running) driver_->stop_sampling();
  const bool after = send_safe();
  stage_ = Stage::open, is_stopped_ = true;
  (void)before;  // a first attempt, while the device still samples; the second one counts
  // In protected mode a device may take writes without following them.
  if (fault_.code == Code::watchdog && driver_->watchdog_took_over())
    return outputs_safe_ = OutputsSafe::by_watchdog;
  if (after && driver_->capabilities().reads_back) {
    driver_->disarm();
    outputs_safe_ = OutputsSafe::confirmed;
  } else {
    outputs_safe_ = driver_->watchdog_took_over() ? OutputsSafe::by_watchdog : OutputsSafe::unknown;
  }
  return outputs_safe_;
}

void IoDevice::close() noexcept {
  if (stage_ == Stage::closed) return;
  if (has_written_ && !is_stopped_) stop();
  driver_->close();
  stage_ = Stage::closed;
}

Status IoDevice::rearm() {
  if (stage_ == Stage::closed) return {Code::not_open};
  const Status status = driver_->rearm();
  if (!status.ok()) return status;
  fault_ = {};
  if (stage_ == Stage::open) has_written_ = false;
  return status;
}

}  // namespace loopwright::hw
