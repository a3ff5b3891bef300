/// The clock that times the loop.
#pragma once
#include <cerrno>
#include <cstdint>
#include <ctime>

namespace loopwright::hw {

/// Nanoseconds of the computer's clock, for measuring durations.
inline int64_t wall_ns() noexcept {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return int64_t(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

class Clock {
 public:
  virtual ~Clock() = default;
  virtual int64_t now_ns() noexcept = 0;
  /// If the computer is the clock: waits for the next sample instant.
  virtual void sleep_until(int64_t ns) noexcept = 0;
  /// If the device is the clock: a sample that was due then has arrived.
  virtual void sampled(int64_t /*due_ns*/) noexcept {}
};

class MonotonicClock final : public Clock {
 public:
  int64_t now_ns() noexcept override { return wall_ns(); }
  void sleep_until(int64_t ns) noexcept override {
    const timespec t{time_t(ns / 1'000'000'000), long(ns % 1'000'000'000)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
    }
  }
};

/// For a device in simulated time, which is not visible here: every sample counts as on time.
class SimulatedClock final : public Clock {
 public:
  int64_t now_ns() noexcept override { return now_; }
  void sleep_until(int64_t ns) noexcept override { now_ = ns; }
  void sampled(int64_t due_ns) noexcept override { now_ = due_ns; }

 private:
  int64_t now_ = 0;
};

}  // namespace loopwright::hw
