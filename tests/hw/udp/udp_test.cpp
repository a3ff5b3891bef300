// Another kind of device behind the same port: loopback only, the device is a thread that answers
// synchronously.
#include "hw/udp/udp.h"
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>
#include <atomic>
#include <cmath>
#include <thread>
#include "hw/realtime/deploy.h"
#include "hw/udp/protocol.h"
#include "tests/hw/device_file.h"
#include "where.h"

namespace loopwright::hw::udp_test {
namespace {

using namespace udp;
using testing::HasSubstr;

/// A mass of 1 kg, 1 N/V, sampled every millisecond of its own time: the next sample follows the command.
class Peer {
 public:
  Peer() {
    socket_ = socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in any{};
    any.sin_family = AF_INET, any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    bind(socket_, reinterpret_cast<sockaddr*>(&any), sizeof any);
    socklen_t size = sizeof any;
    getsockname(socket_, reinterpret_cast<sockaddr*>(&any), &size);
    port = ntohs(any.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~Peer() {
    is_over_ = true;
    shutdown(socket_, SHUT_RDWR);
    thread_.join();
    close(socket_);
  }
  int port = 0;
  std::atomic<double> output = 99;
  std::atomic<int> silent_from = -1, gap_at = -1, gap = 2, expires_at = -1, short_at = -1, bad_at = -1;
  std::atomic<double> bad = 0;
  std::atomic<int> stops_to_lose = 0;  // its samples go on every 20 ms
  std::atomic<bool> is_deaf_from_stop = false;

 private:
  void serve() {
    ToDevice packet;
    FromDevice last;
    sockaddr_in from{};
    timeval patience{0, 20000};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    while (!is_over_) {
      socklen_t size = sizeof from;
      if (recvfrom(socket_, &packet, sizeof packet, 0, reinterpret_cast<sockaddr*>(&from), &size) !=
              sizeof packet ||
          is_lost(packet)) {
        if (has_lost_a_stop_ && is_sampling_) {
          last.sequence = ++sequence_;
          sendto(socket_, &last, sizeof last, 0, reinterpret_cast<sockaddr*>(&from), sizeof from);
        }
        continue;
      }
      if (silent_from >= 0 && int(sequence_) >= silent_from) continue;
      last = take(packet);
      sendto(socket_, &last, sizeof last, 0, reinterpret_cast<sockaddr*>(&from), size);
    }
  }
  bool is_lost(const ToDevice& packet) {
    if (packet.request == Request::stop && stops_to_lose > 0) return --stops_to_lose, has_lost_a_stop_ = true;
    return has_lost_a_stop_ && is_deaf_from_stop;
  }
  FromDevice take(const ToDevice& packet) {
    if (packet.request == Request::start) is_sampling_ = true, sequence_ = 0;
    if (packet.request == Request::stop) is_sampling_ = false;
    if (packet.request == Request::configure) safe_ = packet.raw[0];
    if (packet.request == Request::command) output = packet.raw[0];
    FromDevice answer;
    answer.answered = packet.number, answer.channels = 1;
    if (is_sampling_) {
      const uint32_t before = sequence_++;
      if (int(sequence_) == gap_at) sequence_ += uint32_t(gap);
      for (uint32_t i = before; i < sequence_; ++i)
        velocity_ += 1e-3 * (output - 20 * velocity_), position_ += 1e-3 * velocity_;
    }
    if (expires_at >= 0 && int(sequence_) >= expires_at)
      answer.state = DeviceState::watchdog_expired, output = safe_;
    answer.sequence = sequence_;
    answer.raw[0] = int(sequence_) == bad_at ? bad.load() : std::floor(position_ / 2e-7);
    if (int(sequence_) == short_at) answer.channels = 0;
    return answer;
  }
  int socket_;
  std::thread thread_;
  std::atomic<bool> is_over_ = false;
  bool is_sampling_ = false, has_lost_a_stop_ = false;
  uint32_t sequence_ = 0;
  double position_ = 0, velocity_ = 0, safe_ = 99;
};

std::string device_file(int port) {
  nlohmann::ordered_json device =
      nlohmann::ordered_json::parse(std::ifstream(LOOPWRIGHT_SOURCE "/hw/devices/udp_axis.json"));
  device["udp"] = {{"address", "127.0.0.1"}, {"port", port}, {"patience", 0.2}};
  device["clock"]["time"] = "simulated";
  return device.dump();
}

DeployResult deploy_on(const Peer& peer) {
  DiagramFolder folder;
  folder.with("device.json", device_file(peer.port));
  LoadOptions options;
  options.set = {{"axis.device", folder.path("device.json")}};
  const auto plan = load_plan(LOOPWRIGHT_SOURCE "/diagrams/examples/hardware_io.json", options);
  Problems problems;
  const Hardware hardware = find_hardware(*plan, problems);
  auto driver = find_driver("udp")->make(hardware.device, problems);
  EXPECT_EQ(problems.text(), "");
  IoDevice device(hardware.device, std::move(driver));
  return deploy(*plan, hardware, device, {});
}

TEST(Udp, TheSameDiagramRunsOnAnotherKindOfDevice) {
  Peer peer;
  const DeployResult result = deploy_on(peer);
  EXPECT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
  EXPECT_EQ(peer.output, 0);
  EXPECT_EQ(result.statistics.cycles, 1001);
  // A ramp of 10 mm/s against a damping of 20 V s/m, held by 1000 V/m: a lag of 0.2 mm.
  EXPECT_NEAR(result.recording.find("axis.position")->values.back(), 0.01 - 0.2e-3, 2e-5);
}

TEST(Udp, ModelTimeFollowsTheNumbersOfItsSamples) {
  Peer peer;
  peer.gap_at = 500;
  const DeployResult result = deploy_on(peer);
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_EQ(result.statistics.lost_samples, 2);
  EXPECT_EQ(result.statistics.cycles, 999) << "every instant of the second has a row but two";
  const auto &time = result.recording.find("time")->values,
             &lost = result.recording.find("loop.lost")->values,
             &reference = result.recording.find("reference.y")->values;
  for (size_t row = 1; row < time.size(); ++row) {
    EXPECT_NEAR(time[row] - time[row - 1], 1e-3 * (1 + lost[row]), 1e-12);
    EXPECT_NEAR(reference[row], 0.01 * time[row], 1e-15);
  }
  EXPECT_EQ(time.back(), 1);
  EXPECT_NEAR(result.recording.find("axis.position")->values.back(), 0.01 - 0.2e-3, 2e-5);
}

TEST(Udp, AGapBeyondTheBoundIsAFault) {
  Peer peer;
  peer.gap_at = 500, peer.gap = 3;
  const DeployResult result = deploy_on(peer);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_THAT(result.message, HasSubstr("lost 3 samples in a row"));
  EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
  EXPECT_EQ(peer.output, 0);
}

TEST(Udp, APacketWithoutItsChannelsOrWithNoNumberIsAFault) {
  const auto message_of = [](auto&& prepare) {
    Peer peer;
    prepare(peer);
    const DeployResult result = deploy_on(peer);
    EXPECT_EQ(result.status, RunStatus::failed);
    EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
    EXPECT_EQ(peer.output, 0);
    return result.message;
  };
  EXPECT_THAT(message_of([](Peer& peer) { peer.short_at = 300; }),
              HasSubstr("input \"position\" (encoder 0) read nan"));
  EXPECT_THAT(message_of([](Peer& peer) { peer.bad_at = 300, peer.bad = 1e300; }),
              HasSubstr("read 1e+300 counts"));
  EXPECT_THAT(message_of([](Peer& peer) { peer.bad_at = 1, peer.bad = std::nan(""); }),
              HasSubstr("the diagram has not begun"));
}

TEST(Udp, ADeviceThatFallsSilentIsGoneAndItsOutputsUnknown) {
  Peer peer;
  peer.silent_from = 200;
  const DeployResult result = deploy_on(peer);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_EQ(result.fault.code, Code::disconnected);
  EXPECT_THAT(result.message, HasSubstr("does not answer"));
  EXPECT_EQ(result.outputs_safe, OutputsSafe::unknown);
  EXPECT_EQ(result.recording.rows(), 199u) << "the first sample only confirms the second";
}

TEST(Udp, AStopThatWasLostIsSentAgain) {
  Peer peer;
  peer.stops_to_lose = 2;
  const DeployResult result = deploy_on(peer);
  EXPECT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_EQ(result.outputs_safe, OutputsSafe::confirmed);
  EXPECT_EQ(peer.stops_to_lose, 0);
  EXPECT_EQ(peer.output, 0);
}

TEST(Udp, ADeviceThatSamplesButTakesNothingIsGivenUpAndItsOutputsUnknown) {
  Peer peer;
  peer.stops_to_lose = 100, peer.is_deaf_from_stop = true;
  const DeployResult result = deploy_on(peer);
  EXPECT_EQ(result.outputs_safe, OutputsSafe::unknown);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_LE(peer.stops_to_lose, 100 - 3) << "three attempts";
}

TEST(Udp, ItsWatchdogIsReported) {
  Peer peer;
  peer.expires_at = 300;
  const DeployResult result = deploy_on(peer);
  EXPECT_EQ(result.fault.code, Code::watchdog);
  EXPECT_EQ(result.outputs_safe, OutputsSafe::by_watchdog);
  EXPECT_EQ(peer.output, 0);
}

TEST(Udp, NobodyThereIsToldBeforeTheLoopBegins) {
  Peer peer;
  peer.silent_from = 0;
  const DeployResult result = deploy_on(peer);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_THAT(result.message, HasSubstr("cannot be set up"));
  EXPECT_EQ(result.statistics.cycles, 0);
}

TEST(Udp, AWrongAddressIsAProblemOfTheFile) {
  auto device = nlohmann::ordered_json::parse(device_file(5000));
  device["udp"]["address"] = "axis.example";
  EXPECT_THAT(problems_of_device(device.dump()), HasSubstr("four numbers with dots"));
  device["udp"] = {{"adress", "127.0.0.1"}};
  EXPECT_THAT(problems_of_device(device.dump()),
              testing::AllOf(HasSubstr("\"port\" is missing"), HasSubstr("did you mean \"address\"")));
}

}  // namespace
}  // namespace loopwright::hw::udp_test
