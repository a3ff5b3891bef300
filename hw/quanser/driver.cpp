#include <fmt/format.h>
#include <atomic>
#include <cmath>
#include <ctime>
#include "hw/quanser/card_in_use.h"
#include "hw/quanser/errors.h"
#include "hw/quanser/library.h"
#include "hw/quanser/quanser.h"
#include "models/real/whole.h"

namespace loopwright::hw::quanser {
namespace {

constexpr int32_t function_not_supported = -94;

/// Channels of one kind, and the indices of their numbers among all inputs of the description.
struct InputGroup {
  std::vector<uint32_t> channels;
  std::vector<size_t> places;
  const uint32_t* list() const { return channels.empty() ? nullptr : channels.data(); }
  uint32_t count() const { return uint32_t(channels.size()); }
};

/// Counts the calls from other threads that are under way.
class Visit {
 public:
  explicit Visit(std::atomic<int>& count) noexcept : count_(count) { ++count_; }
  ~Visit() { --count_; }
  Visit(const Visit&) = delete;
  Visit& operator=(const Visit&) = delete;

 private:
  std::atomic<int>& count_;
};

class QuanserDriver final : public Driver {
 public:
  QuanserDriver(std::shared_ptr<const DeviceDescription> device, Settings settings, Library library)
      : device_(std::move(device)), settings_(std::move(settings)), library_(std::move(library)) {
    for (size_t i = 0; i < device_->inputs.size(); ++i) {
      const InputChannel& input = device_->inputs[i];
      InputGroup& group = input.kind == InputKind::encoder  ? encoders_
                          : input.kind == InputKind::analog ? analog_
                                                            : other_;
      const uint32_t base = input.kind == InputKind::encoder_velocity ? other_encoder_velocity : 0;
      group.channels.push_back(base + uint32_t(input.channel));
      group.places.push_back(i);
    }
    for (const OutputChannel& output : device_->outputs) outputs_.push_back(uint32_t(output.channel));
    counts_.resize(encoders_.count()), analog_values_.resize(analog_.count()),
        other_values_.resize(other_.count());
  }
  ~QuanserDriver() override { close(); }

  Capabilities capabilities() const override {
    const bool is_clock = device_->clock.source == ClockSource::device;
    const double watchdog = device_->watchdog.timeout;
    // Not re-entrant: the vendor does not document which calls may run concurrently.
    return {is_clock, watchdog > 0, is_clock, true, false, watchdog};
  }

  Status open() override {
    step_ = "hil_open";
    t_card card = nullptr;
    const t_error result = call().hil_open(settings_.board.c_str(), settings_.identifier.c_str(), &card);
    card_ = result < 0 ? nullptr : card;
    is_asked_to_stop_ = false, is_armed_ = false;
    return status_of(result, false);
  }
  /// The library cannot close a single card of another program: all cards that the program has open are
  /// closed.
  Status take_over() override {
    step_ = "hil_close_all";
    if (!call().hil_close_all) return {Code::unsupported, function_not_supported};
    if (const t_error result = call().hil_close_all(); result < 0) return status_of(result, false);
    return open();
  }

  Status configure(std::span<const double> safe) override;
  Status start(double period_s) override;
  std::string describe(Status status) const override;
  std::vector<std::string> facts() const override;

  Status read(RawSample& sample, std::span<double> raw) noexcept override;
  Status write(std::span<const double> raw) noexcept override {
    if (!card_) return {Code::not_open};
    if (outputs_.empty()) return {};
    return status_of(call().hil_write_analog(card_, outputs_.data(), uint32_t(outputs_.size()), raw.data()));
  }
  Status kick() noexcept override;
  void request_stop() noexcept override {
    is_asked_to_stop_ = true;
    const Visit visit(visits_);
    if (const t_task task = task_) call().hil_task_stop(task);
  }

  void emergency_stop(std::span<const double> safe) noexcept override {
    const Visit visit(visits_);
    if (const t_card card = card_; card && !outputs_.empty())
      call().hil_write_analog(card, outputs_.data(), uint32_t(outputs_.size()), safe.data());
  }

  void stop_sampling() noexcept override {
    if (task_) call().hil_task_stop(task_);
  }
  void disarm() noexcept override {
    if (has_termination_states_) call().hil_write_termination_states(card_);
    if (is_armed_ && call().hil_watchdog_stop) call().hil_watchdog_stop(card_);
    is_armed_ = false;
  }
  bool watchdog_took_over() noexcept override;
  void close() noexcept override {
    const t_task task = task_.exchange(nullptr);
    const t_card card = card_.exchange(nullptr);
    // A call from another thread that began before still uses them. If it hangs, they are left to the system.
    const timespec moment{0, 100'000};
    for (int i = 0; visits_ > 0 && i < 1000; ++i) nanosleep(&moment, nullptr);
    if (visits_ > 0) return;
    if (task) call().hil_task_delete(task);
    if (card) call().hil_close(card);
  }
  Status rearm() override {
    is_armed_ = false, is_asked_to_stop_ = false;
    return call().hil_watchdog_clear ? status_of(call().hil_watchdog_clear(card_)) : Status{};
  }

 private:
  const HilFunctions& call() const { return library_.functions; }
  static Status status_of(t_error result, bool while_open = true) noexcept {
    return result >= 0 ? Status{} : Status{classify(result, while_open), result};
  }
  /// The status of a set-up call. For a function that the card may lack, an error only if it was `wanted`.
  template <class F, class... A> Status set_up(const char* name, bool wanted, F* function, A... arguments) {
    step_ = name;
    const t_error result = function ? function(arguments...) : function_not_supported;
    if (!wanted && (is_not_supported(result) || !function)) return {};
    return status_of(result);
  }
  Status set_ranges();
  Status set_encoders();
  Status set_watchdog(std::span<const double> safe);
  Status read_now() noexcept;
  void spread(std::span<double> raw) const noexcept;

  std::shared_ptr<const DeviceDescription> device_;
  Settings settings_;
  Library library_;
  // request_stop() and emergency_stop() read them in other threads while close() takes them away.
  std::atomic<t_card> card_ = nullptr;
  std::atomic<t_task> task_ = nullptr;
  std::atomic<int> visits_ = 0;
  InputGroup encoders_, analog_, other_;
  std::vector<uint32_t> outputs_;
  std::vector<int32_t> counts_;
  std::vector<double> analog_values_, other_values_;
  std::atomic<bool> is_asked_to_stop_ = false;
  bool is_armed_ = false, has_termination_states_ = false;
  int64_t sequence_ = 0;   // samples read
  const char* step_ = "";  // of the set-up, for messages
};

// ---- set-up, in the order used by the vendor's own generated programs ----

Status QuanserDriver::configure(std::span<const double> safe) {
  const bool has_options = !settings_.options.empty();
  Status status = !has_options
                      ? Status{}
                      : set_up("hil_set_card_specific_options", true, call().hil_set_card_specific_options,
                               card_.load(), settings_.options.c_str(), settings_.options.size() + 1);
  if (status.ok()) status = set_up("hil_watchdog_clear", false, call().hil_watchdog_clear, card_.load());
  if (status.ok()) status = set_ranges();
  step_ = "hil_write_analog";
  if (status.ok()) status = write(safe);
  if (status.ok()) status = set_watchdog(safe);
  if (status.ok()) status = set_encoders();
  if (!status.ok() || device_->clock.source == ClockSource::host) return status;
  t_task task = nullptr;
  status = set_up("hil_task_create_reader", true, call().hil_task_create_reader, card_.load(),
                  uint32_t(device_->clock.buffer), analog_.list(), analog_.count(), encoders_.list(),
                  encoders_.count(), channel_list{}, 0u, other_.list(), other_.count(), &task);
  if (!status.ok()) return status;
  task_ = task;
  const bool overwrites = device_->clock.overflow == Overflow::overwrite;
  if (overwrites && !call().hil_task_get_buffer_overflows)
    return step_ = "hil_task_get_buffer_overflows", Status{Code::unsupported, function_not_supported};
  return set_up("hil_task_set_buffer_overflow_mode", overwrites, call().hil_task_set_buffer_overflow_mode,
                task_.load(), overwrites ? overflow_drops_oldest : overflow_is_error);
}

/// Ranges that the file leaves unchanged need no function to set them.
Status QuanserDriver::set_ranges() {
  std::vector<double> low, high;
  const auto take = [&](const auto& channels, bool (*counts)(InputKind)) {
    low.clear(), high.clear();
    bool is_usual = true;
    for (const auto& channel : channels) {
      if constexpr (requires { channel.kind; })
        if (!counts(channel.kind)) continue;
      low.push_back(channel.low), high.push_back(channel.high);
      is_usual &= channel.low == -10 && channel.high == 10;
    }
    return is_usual;
  };
  bool is_usual = take(device_->inputs, [](InputKind kind) { return kind == InputKind::analog; });
  if (!low.empty())
    if (const Status status =
            set_up("hil_set_analog_input_ranges", !is_usual, call().hil_set_analog_input_ranges, card_.load(),
                   analog_.list(), analog_.count(), volts(low.data()), volts(high.data()));
        !status.ok())
      return status;
  is_usual = take(device_->outputs, nullptr);
  if (low.empty()) return {};
  return set_up("hil_set_analog_output_ranges", !is_usual, call().hil_set_analog_output_ranges, card_.load(),
                channel_list(outputs_.data()), uint32_t(outputs_.size()), volts(low.data()),
                volts(high.data()));
}

Status QuanserDriver::set_encoders() {
  std::vector<int32_t> quadrature, preset;
  std::vector<double> filter;
  bool has_mode = false, has_filter = false, has_preset = false;
  for (const size_t place : encoders_.places) {
    const InputChannel& encoder = device_->inputs[place];
    quadrature.push_back(encoder.quadrature), preset.push_back(encoder.preset),
        filter.push_back(encoder.filter);
    has_mode |= encoder.quadrature != 4, has_filter |= encoder.filter > 0, has_preset |= encoder.preset != 0;
  }
  if (preset.empty()) return {};
  Status status = set_up("hil_set_encoder_quadrature_mode", has_mode, call().hil_set_encoder_quadrature_mode,
                         card_.load(), encoders_.list(), encoders_.count(),
                         static_cast<const int32_t*>(quadrature.data()));
  if (status.ok() && has_filter)
    status = set_up("hil_set_encoder_filter_frequency", true, call().hil_set_encoder_filter_frequency,
                    card_.load(), encoders_.list(), encoders_.count(), volts(filter.data()));
  if (status.ok())
    status = set_up("hil_set_encoder_counts", has_preset, call().hil_set_encoder_counts, card_.load(),
                    encoders_.list(), encoders_.count(), static_cast<const int32_t*>(preset.data()));
  return status;
}

/// All outputs of the card get a watchdog state, ours their safe value: some cards accept only all or none.
Status QuanserDriver::set_watchdog(std::span<const double> safe) {
  std::vector<uint32_t> channels;
  std::vector<double> states(size_t(settings_.analog_outputs), 0.0);
  for (int i = 0; i < settings_.analog_outputs; ++i) channels.push_back(uint32_t(i));
  for (size_t i = 0; i < outputs_.size(); ++i) states[outputs_[i]] = safe[i];  // in it: see read_settings
  const auto count = uint32_t(channels.size());
  if (device_->watchdog.timeout > 0) {
    for (const auto& [name, function] : {std::pair{"hil_watchdog_start", (void*)call().hil_watchdog_start},
                                         std::pair{"hil_watchdog_reload", (void*)call().hil_watchdog_reload}})
      if (!function) return step_ = name, Status{Code::unsupported, function_not_supported};
    const Status status = set_up("hil_watchdog_set_analog_expiration_state", true,
                                 call().hil_watchdog_set_analog_expiration_state, card_.load(),
                                 channel_list(channels.data()), count, volts(states.data()));
    if (!status.ok()) return status;
  }
  const auto termination = call().hil_set_analog_termination_state;
  has_termination_states_ = termination && call().hil_write_termination_states &&
                            termination(card_, channels.data(), count, states.data()) == 0;
  return {};
}

Status QuanserDriver::start(double period_s) {
  sequence_ = 0;
  if (device_->clock.source == ClockSource::host) return {};
  return set_up("hil_task_start", true, call().hil_task_start, task_.load(), int32_t(settings_.clock),
                1 / period_s, until_stopped);
}

std::string QuanserDriver::describe(Status status) const {
  if (status.native == 0) return "";
  if (status.code == Code::busy && !card_) return who_has(settings_, library_, status.native);
  char text[512] = "";
  if (call().msg_get_error_messageA) call().msg_get_error_messageA(nullptr, status.native, text, sizeof text);
  const std::string_view name = error_name(status.native);
  return fmt::format("{} ({}{}{}){}{}", text[0] ? text : "the card answered with an error", status.native,
                     name.empty() ? "" : ", ", name, step_[0] ? " at " : "", step_);
}

std::vector<std::string> QuanserDriver::facts() const {
  std::vector<std::string> lines{fmt::format("library {}", library_.path)};
  t_version version{sizeof(t_version), 0, 0, 0, 0};
  if (call().hil_get_version && call().hil_get_version(&version) == 0)
    lines.back() +=
        fmt::format(", version {}.{}.{}.{}", version.major, version.minor, version.release, version.build);
  if (!library_.missing.empty())
    lines.push_back(fmt::format("not in the library: {}", fmt::join(library_.missing, ", ")));
  lines.push_back(fmt::format("board {} {}", settings_.board, settings_.identifier));
  for (const auto& [name, property] :
       {std::pair{"product", property_product_name}, std::pair{"serial number", property_serial_number},
        std::pair{"firmware", property_firmware}}) {
    char text[128] = "";
    if (card_ && call().hil_get_string_property &&
        call().hil_get_string_property(card_, property, text, sizeof text) >= 0)
      lines.push_back(fmt::format("{} {}", name, text));
  }
  return lines;
}

// ---- the loop ----

Status QuanserDriver::read(RawSample& sample, std::span<double> raw) noexcept {
  if (!card_) return {Code::not_open};
  step_ = "";
  if (device_->clock.source == ClockSource::host) {
    const Status status = is_asked_to_stop_ ? Status{Code::stopped} : read_now();
    sample.sequence = sequence_++;
    spread(raw);
    return status;
  }
  const t_error result =
      call().hil_task_read(task_, 1, analog_values_.data(), counts_.data(), nullptr, other_values_.data());
  if (result < 0) return status_of(result);
  if (result == 0) return {Code::stopped};  // no error: the task was stopped or has finished
  sample.sequence = sequence_++;
  if (device_->clock.overflow == Overflow::overwrite) {
    const t_error dropped = call().hil_task_get_buffer_overflows(task_);
    if (dropped < 0) return status_of(dropped);  // the time is unknown
    sample.sequence += dropped;  // all dropped before this sample, which was read from a buffer of newer ones
  }
  spread(raw);
  return {};
}

Status QuanserDriver::read_now() noexcept {
  t_error result = 0;
  if (encoders_.count())
    result = call().hil_read_encoder
                 ? call().hil_read_encoder(card_, encoders_.list(), encoders_.count(), counts_.data())
                 : function_not_supported;
  if (result >= 0 && analog_.count())
    result = call().hil_read_analog
                 ? call().hil_read_analog(card_, analog_.list(), analog_.count(), analog_values_.data())
                 : function_not_supported;
  if (result >= 0 && other_.count())
    result = call().hil_read_other
                 ? call().hil_read_other(card_, other_.list(), other_.count(), other_values_.data())
                 : function_not_supported;
  return status_of(result);
}

void QuanserDriver::spread(std::span<double> raw) const noexcept {
  for (size_t i = 0; i < encoders_.places.size(); ++i) raw[encoders_.places[i]] = counts_[i];
  for (size_t i = 0; i < analog_.places.size(); ++i) raw[analog_.places[i]] = analog_values_[i];
  for (size_t i = 0; i < other_.places.size(); ++i) raw[other_.places[i]] = other_values_[i];
}

/// 1: reloaded in time; 0: it had expired.
Status QuanserDriver::kick() noexcept {
  if (device_->watchdog.timeout <= 0) return {};
  if (!is_armed_) {
    step_ = "hil_watchdog_start";
    const t_error result = call().hil_watchdog_start(card_, device_->watchdog.timeout);
    is_armed_ = result >= 0;
    return status_of(result);
  }
  const t_error result = call().hil_watchdog_reload(card_);
  if (result == 0) return {Code::watchdog};
  return status_of(result);
}

bool QuanserDriver::watchdog_took_over() noexcept {
  if (!card_ || !is_armed_ || !call().hil_watchdog_is_expired) return false;
  t_error result = call().hil_watchdog_is_expired(card_);
  if (result == 0) {
    const double wait_s = device_->watchdog.timeout + 2e-3;
    const timespec wait{whole_between<time_t>(wait_s, 0, 1000),
                        whole_between(1e9 * (wait_s - std::floor(wait_s)), 0L, 999'999'999L)};
    nanosleep(&wait, nullptr);
    result = call().hil_watchdog_is_expired(card_);
  }
  return result == 1;
}

}  // namespace

std::string foreign_code(const DeviceDescription& device) {
  Problems ignored;  // reported when the device was loaded
  return library_to_load(read_settings(device, ignored).library);
}

std::unique_ptr<Driver> make_driver(std::shared_ptr<const DeviceDescription> device, Problems& problems) {
  const size_t before = problems.list().size();
  Settings settings = read_settings(*device, problems);
  if (problems.list().size() != before) return nullptr;
  Library library;
  LibraryProblem why;
  if (!load_library(settings.library, library, why)) {
    const Value::Member* named = device->driver_settings.find("library");
    const Value& at = named ? named->value : device->driver_settings;
    auto& p = problems.error(at.place, at.place.pointer(), "", why.message);
    p.found = why.found;
    p.hint = why.hint;
    return nullptr;
  }
  return std::make_unique<QuanserDriver>(std::move(device), std::move(settings), std::move(library));
}

}  // namespace loopwright::hw::quanser
