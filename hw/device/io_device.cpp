#include "hw/device/io_device.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include "hw/device/output.h"

namespace loopwright::hw {
namespace {
constexpr int most_jumps = 3;          // consecutive; more indicate a broken sensor, not a glitch
constexpr int most_first_samples = 4;  // two consecutive ones must agree
}  // namespace

std::string_view to_name(Code code) {
  static constexpr std::string_view names[] = {
      "ok",           "stopped",     "late",         "lost",     "range", "watchdog", "device_fault",
      "disconnected", "unsupported", "config_error", "not_open", "busy",  "no_driver"};
  return names[size_t(code)];
}
std::string_view to_name(OutputsSafe safe) {
  static constexpr std::string_view names[] = {"confirmed", "by_watchdog", "unknown", "untouched"};
  return names[size_t(safe)];
}

IoDevice::IoDevice(std::shared_ptr<const DeviceDescription> description, std::unique_ptr<Driver> driver)
    : description_(std::move(description)), driver_(std::move(driver)) {
  raw_in_.resize(description_->inputs.size());
  has_rates_ = std::ranges::any_of(description_->inputs,
                                   [](const InputChannel& input) { return input.maximum_rate > 0; });
  for (const OutputChannel& output : description_->outputs) {
    raw_safe_.push_back(output.volts(output.safe));
    raw_initial_.push_back(output.volts(output.initial));
    applied_.push_back(output.initial);
  }
  raw_out_ = raw_safe_;
}

std::string IoDevice::describe(Status status) const {
  const bool is_own = status.native == 0 && (status.code == Code::device_fault || status.code == Code::range);
  if (is_own && incident_.what != Incident::What::none) return explain(incident_, *description_);
  const std::string text = driver_->describe(status);
  return fmt::format("{}{}{}", sentence_of(status.code), text.empty() ? "" : ": ", text);
}

Status IoDevice::latch(Status status) noexcept {
  if (latches(status.code) && !latches(fault_.code)) fault_ = status;
  return status;
}

Status IoDevice::open() {
  if (stage_ == Stage::open) return {};
  if (stage_ != Stage::closed) return {Code::busy};
  return opened(driver_->open());
}

Status IoDevice::take_over() {
  if (stage_ != Stage::closed) return {Code::busy};
  const Status status = opened(driver_->take_over());
  if (status.code != Code::unsupported)
    outputs_safe_ = OutputsSafe::unknown;                     // as the other program left them
  if (status.ok()) has_written_ = true, is_stopped_ = false;  // close() must not leave them so
  return status;
}

Status IoDevice::opened(Status status) {
  if (status.ok()) stage_ = Stage::open;
  return status;
}

Status IoDevice::preset() {
  if (stage_ != Stage::open) return {Code::not_open};
  has_written_ = true, is_stopped_ = false;  // also if it fails halfway
  outputs_safe_ = OutputsSafe::unknown;
  const Status status = driver_->configure(raw_safe_);
  if (!status.ok()) return latch(status);
  stage_ = Stage::ready;
  return status;
}

Status IoDevice::start(double period_s) {
  if (stage_ != Stage::ready) return {Code::not_open};
  period_s_ = period_s;
  inputs_.clear();
  for (const InputChannel& channel : description_->inputs) inputs_.emplace_back(channel, period_s);
  has_begun_ = false, last_sequence_ = -1, incident_ = {};
  if (const Status status = driver_->start(period_s); !status.ok()) return latch(status);
  stage_ = Stage::running;
  // The first command is limited in its rate from here, not from where an earlier run ended.
  for (size_t i = 0; i < applied_.size(); ++i) applied_[i] = description_->outputs[i].initial;
  Status status = driver_->kick();  // from here on the watchdog guards whatever is put out
  if (status.ok() && raw_initial_ != raw_safe_) status = send(raw_initial_);
  return latch(status);
}

/// A sample of the driver with its number, not yet converted.
Status IoDevice::take_sample(Sample& sample) noexcept {
  RawSample raw;
  std::ranges::fill(raw_in_, std::numeric_limits<double>::quiet_NaN());
  if (const Status status = driver_->read(raw, raw_in_); !status.ok()) return status;
  sample = {raw.sequence, raw.sequence - last_sequence_ - 1, 0};
  if (raw.sequence <= last_sequence_) {
    incident_ = {.what = Incident::What::numbering, .sample = raw.sequence, .sample_before = last_sequence_};
    return {Code::device_fault};
  }
  last_sequence_ = raw.sequence;
  return {};
}

Status IoDevice::refuse(size_t i, Reading reading) noexcept {
  incident_ = {.what = Incident::What::input,
               .channel = i,
               .reading = reading,
               .number = raw_in_[i],
               .value_before = inputs_[i].value(),
               .in_row = inputs_[i].bad_in_row(),
               .has_begun = has_begun_};
  return {Code::device_fault};
}

/// Whether the previous value may replace a bad reading once more.
bool IoDevice::may_hold(const Input& input, Reading reading) const noexcept {
  if (!input.is_known()) return false;
  if (reading == Reading::jump) return input.bad_in_row() < most_jumps;
  const Policy& policy = description_->policy;
  return policy.on_invalid == OnInvalid::hold && input.bad_in_row() < policy.most_invalid;
}

Status IoDevice::send_initial() noexcept {
  const Status status = send(raw_initial_);
  return status.ok() ? driver_->kick() : status;
}

/// Before anything moves, two consecutive samples must agree: a single sample cannot be recognized as a
/// glitch. Meanwhile the initial values are written, for devices that expect a command for every sample.
Status IoDevice::read_first(Sample& sample) noexcept {
  size_t jumped = 0;
  for (int taken = 0; taken < most_first_samples; ++taken) {
    if (taken > 0)
      if (const Status status = send_initial(); !status.ok()) return status;
    if (const Status status = take_sample(sample); !status.ok()) return status;
    bool agree = taken > 0 || !has_rates_;
    for (size_t i = 0; i < inputs_.size(); ++i) {
      Reading reading = inputs_[i].take(raw_in_[i], sample.lost + 1);
      if (reading == Reading::jump) {  // one of the two is wrong: keep the later one
        agree = false, jumped = i;
        inputs_[i].forget();
        reading = inputs_[i].take(raw_in_[i], 1);
      }
      if (reading != Reading::good) return refuse(i, reading);
    }
    if (agree) return has_begun_ = true, Status{};
  }
  return refuse(jumped, Reading::jump);
}

Status IoDevice::read_next(Sample& sample) noexcept {
  if (const Status status = take_sample(sample); !status.ok()) return status;
  Status worst;
  for (size_t i = 0; i < inputs_.size(); ++i) {
    const Reading reading = inputs_[i].take(raw_in_[i], sample.lost + 1);
    if (reading == Reading::good) continue;
    ++sample.glitches, ++glitches_;
    if (worst.ok() && !may_hold(inputs_[i], reading)) worst = refuse(i, reading);
  }
  return worst;
}

Status IoDevice::read(Sample& sample, std::span<double> values) noexcept {
  if (stage_ != Stage::running) return {Code::not_open};
  const Status status = has_begun_ ? read_next(sample) : read_first(sample);
  for (size_t i = 0; i < std::min(values.size(), inputs_.size()); ++i) values[i] = inputs_[i].value();
  return latch(status);
}

Status IoDevice::write(std::span<const double> values) noexcept {
  if (stage_ == Stage::closed) return {Code::not_open};
  if (latches(fault_.code)) {
    send_safe();
    return fault_;
  }
  const auto bad = std::ranges::find_if(values, [](double v) { return !std::isfinite(v); });
  if (values.size() != applied_.size() || bad != values.end()) {
    if (bad != values.end() && values.size() == applied_.size() && !latches(fault_.code))
      incident_ = {.what = Incident::What::output, .channel = size_t(bad - values.begin()), .number = *bad};
    latch({Code::device_fault, 0});
    send_safe();
    return {Code::range};
  }
  has_written_ = true, is_stopped_ = false, outputs_safe_ = OutputsSafe::unknown;
  for (size_t i = 0; i < values.size(); ++i) {
    const OutputChannel& output = description_->outputs[i];
    const LimitedOutput sent = limited(output, values[i], applied_[i], period_s_);
    clamped_ += sent.is_clamped, rate_limited_ += sent.is_rate_limited;
    applied_[i] = sent.value;
    raw_out_[i] = output.volts(sent.value);
  }
  return latch(send(raw_out_));
}

/// A value already being written when the emergency stop came must not be the last one.
Status IoDevice::send(std::span<const double> raw) noexcept {
  const Status status = driver_->write(is_emergency_ ? raw_safe_ : raw);
  return is_emergency_ ? driver_->write(raw_safe_) : status;
}

void IoDevice::emergency_stop() noexcept {
  is_emergency_ = true;
  driver_->emergency_stop(raw_safe_);
}

std::function<void()> IoDevice::call_of_emergency_stop() const {
  return [driver = driver_, safe = raw_safe_] { driver->emergency_stop(safe); };
}

std::function<void()> IoDevice::call_of_request_stop() const {
  return [driver = driver_] { driver->request_stop(); };
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

OutputsSafe IoDevice::stop() noexcept {
  if (stage_ == Stage::closed) return outputs_safe_;
  const bool before = send_safe();
  if (stage_ == Stage::running) driver_->stop_sampling();
  const bool after = send_safe();
  stage_ = Stage::open, is_stopped_ = true;
  (void)before;  // a first attempt, while the device still samples; the second attempt decides
  // In protected mode a device may accept writes without applying them.
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
