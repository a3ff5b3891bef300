#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>
#include <atomic>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include "hw/device/units.h"
#include "hw/realtime/clock.h"
#include "hw/udp/protocol.h"
#include "hw/udp/udp.h"
#include "models/real/whole.h"

namespace loopwright::hw::udp {
namespace {

static_assert(std::endian::native == std::endian::little);

class UdpDriver final : public Driver {
 public:
  UdpDriver(std::shared_ptr<const DeviceDescription> device, Settings settings)
      : device_(std::move(device)), settings_(std::move(settings)) {}
  ~UdpDriver() override {
    close();
    if (stop_event_ >= 0) ::close(stop_event_);
  }

  Capabilities capabilities() const override {
    return {true, device_->watchdog.timeout > 0, true, true, true, attempts_to_reach * settings_.patience};
  }

  Status open() override {
    socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (stop_event_ < 0) stop_event_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    sockaddr_in peer{};
    peer.sin_family = AF_INET;
    peer.sin_port = htons(uint16_t(settings_.port));
    inet_pton(AF_INET, settings_.address.c_str(), &peer.sin_addr);
    if (socket_ < 0 || stop_event_ < 0 ||
        connect(socket_, reinterpret_cast<sockaddr*>(&peer), sizeof peer) != 0) {
      const int error = errno;
      close();
      return {Code::no_driver, error};
    }
    return {};
  }

  Status configure(std::span<const double> safe) override {
    is_sampling_ = false;
    if (const Status status = exchange(Request::configure, safe); !status.ok()) return status;
    return exchange(Request::command, safe);
  }

  Status start(double period_s) override {
    sequence_ = 0, number_of_sample_ = 0, period_s_ = period_s, is_sampling_ = true;
    return send(Request::start, {});
  }

  std::string describe(Status status) const override {
    const std::string where = fmt::format("{}:{}", settings_.address, settings_.port);
    if (status.code == Code::disconnected && status.native == 0) return where + " does not answer";
    if (status.code == Code::watchdog) return where + " reports that its watchdog has expired";
    if (status.code == Code::device_fault && status.native == 0) return where + " reports a fault";
    return fmt::format("{}: {}", where, std::strerror(status.native));
  }
  std::vector<std::string> facts() const override {
    return {fmt::format("UDP {}:{}", settings_.address, settings_.port)};
  }

  /// Returns the newest sample; older ones still waiting are lost.
  Status read(RawSample& sample, std::span<double> raw) noexcept override {
    FromDevice packet;
    for (const int64_t deadline = wall_ns() + patience_ns();;) {
      if (const Status status = receive(packet, deadline); !status.ok()) return status;
      if (int32_t(packet.sequence - sequence_) > 0) break;  // otherwise an old sample, or an acknowledgment
      if (wall_ns() >= deadline) return {Code::disconnected};
    }
    for (FromDevice newer; take(newer);)
      if (int32_t(newer.sequence - packet.sequence) > 0) packet = newer;
    number_of_sample_ += uint32_t(packet.sequence - sequence_);
    sequence_ = packet.sequence;
    sample.sequence = number_of_sample_ - 1;
    std::copy_n(packet.raw, std::min<size_t>(packet.channels, raw.size()), raw.begin());
    return status_of(packet);
  }

  /// While the device samples, the next sample is the acknowledgment. Before and after, the call waits for
  /// one.
  Status write(std::span<const double> raw) noexcept override {
    return is_sampling_ ? send(Request::command, raw) : exchange(Request::command, raw);
  }
  Status kick() noexcept override { return {}; }  // every command reloads the watchdog
  void request_stop() noexcept override {
    const uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(stop_event_, &one, sizeof one);
  }

  /// Sent three times, because no acknowledgment can be waited for and a packet may be lost.
  void emergency_stop(std::span<const double> safe) noexcept override {
    for (int i = 0; i < 3 && socket_ >= 0; ++i) send(Request::command, safe);
  }

  void stop_sampling() noexcept override {
    is_sampling_ = false;
    uint64_t ignored;
    [[maybe_unused]] const ssize_t drained = ::read(stop_event_, &ignored, sizeof ignored);
    exchange(Request::stop, {});
  }
  void disarm() noexcept override {}  // the device's watchdog stays armed: its values are the safe ones
  bool watchdog_took_over() noexcept override { return exchange(Request::stop, {}).code == Code::watchdog; }
  void close() noexcept override {
    if (const int open = socket_.exchange(-1); open >= 0) ::close(open);
  }
  Status rearm() override { return exchange(Request::clear, {}); }

 private:
  static constexpr int attempts_to_reach = 3;

  static Status status_of(const FromDevice& packet) noexcept {
    if (packet.state == DeviceState::watchdog_expired) return {Code::watchdog};
    return packet.state == DeviceState::fine ? Status{} : Status{Code::device_fault};
  }

  Status send(Request request, std::span<const double> raw) noexcept {
    ToDevice packet;
    packet.number = ++number_, packet.request = request;
    packet.period_s = period_s_, packet.timeout_s = device_->watchdog.timeout;
    packet.channels = uint32_t(raw.size());
    std::copy(raw.begin(), raw.end(), packet.raw);
    if (::send(socket_, &packet, sizeof packet, MSG_NOSIGNAL) == sizeof packet) return {};
    return {errno == EAGAIN ? Code::busy : Code::disconnected, errno};
  }

  /// Reads a packet if one is available.
  bool take(FromDevice& packet) noexcept {
    while (recv(socket_, &packet, sizeof packet, 0) == sizeof packet)
      if (packet.magic == from_device && packet.channels <= most_channels) return true;
    return false;
  }

  int64_t patience_ns() const noexcept {
    return whole_between(1e9 * settings_.patience, int64_t(0), int64_t(3'600'000'000'000));
  }

  /// Waits for the next packet, whichever it is, until the deadline.
  Status receive(FromDevice& packet, int64_t deadline_ns) noexcept {
    pollfd events[] = {{socket_, POLLIN, 0}, {stop_event_, POLLIN, 0}};
    for (;;) {
      const int64_t now = wall_ns();
      if (take(packet)) return heard_ns_ = now, is_silent_ = false, Status{};
      const int64_t left_ms = (std::max<int64_t>(0, deadline_ns - now) + 999'999) / 1'000'000;
      const int answer = poll(events, is_sampling_ ? 2 : 1, int(left_ms));
      if (answer == 0)
        return is_silent_ = heard_ns_ < deadline_ns - patience_ns(), Status{Code::disconnected};
      if (answer < 0 && errno != EINTR) return {Code::device_fault, errno};
      if (is_sampling_ && (events[1].revents & POLLIN)) return {Code::stopped};
      if (events[0].revents & POLLERR) return {Code::disconnected, ECONNREFUSED};
    }
  }

  /// Sends until acknowledged: at most three times, once if the device did not respond before. Every attempt
  /// has a deadline: a device that lost the packet may go on sending samples.
  Status exchange(Request request, std::span<const double> raw) noexcept {
    Status status;
    const int attempts = is_silent_ ? 1 : attempts_to_reach;
    for (int attempt = 0; attempt < attempts; ++attempt) {
      status = send(request, raw);
      const int64_t deadline = wall_ns() + patience_ns();
      FromDevice packet;
      while (status.ok()) {
        status = receive(packet, deadline);
        if (status.ok() && int32_t(packet.answered - number_) >= 0) return status_of(packet);
        if (wall_ns() >= deadline) status = {Code::disconnected};
      }
    }
    return status;
  }

  std::shared_ptr<const DeviceDescription> device_;
  Settings settings_;
  // Another thread may request a stop while the device is closed: its event stays open.
  std::atomic<int> socket_ = -1, stop_event_ = -1;
  std::atomic<uint32_t> number_ = 0;
  uint32_t sequence_ = 0;
  int64_t number_of_sample_ = 0;  // the same, beyond 32 bits
  double period_s_ = 0;
  int64_t heard_ns_ = 0;  // when the last packet came
  bool is_sampling_ = false, is_silent_ = false;
};

}  // namespace

Settings read_settings(const DeviceDescription& device, Problems& problems) {
  Settings settings;
  const Value& section = device.driver_settings;
  read_with_units(settings, section, device.driver, problems);
  in_addr ignored{};
  if (inet_pton(AF_INET, settings.address.c_str(), &ignored) != 1) {
    auto& p = problems.error(section.place, section.place.pointer(), "", "the address cannot be read");
    p.found = "\"" + settings.address + "\"";
    p.expected = "four numbers with dots, as in \"192.168.1.20\"";
  }
  if (device.inputs.size() > most_channels || device.outputs.size() > most_channels)
    problems.error(section.place, section.place.pointer(), "", "a packet has no room for so many channels")
        .expected = fmt::format("at most {} inputs and outputs", most_channels);
  if (device.clock.source == ClockSource::host)
    problems
        .error(section.place, section.place.pointer(), "", "a device that speaks UDP takes its own samples")
        .expected = "\"clock\": {\"source\": \"device\"}";
  return settings;
}

std::unique_ptr<Driver> make_driver(std::shared_ptr<const DeviceDescription> device, Problems& problems) {
  const size_t before = problems.list().size();
  Settings settings = read_settings(*device, problems);
  if (problems.list().size() != before) return nullptr;
  return std::make_unique<UdpDriver>(std::move(device), std::move(settings));
}

}  // namespace loopwright::hw::udp
