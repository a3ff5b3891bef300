/// Whose time the loop lives by.
#pragma once
#include <cerrno>
#include <cstdint>
#include <ctime>

namespace loopwright::hw {

/// Nanoseconds of the computer, for measuring how long something takes.
inline int64_t wall_ns() noexcept {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return int64_t(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

class Clock {
 public:
  virtual ~Clock() = default;
  virtual int64_t now_ns() noexcept = 0;
  /// Where the computer owns time: waits for the next sample instant.
  virtual void sleep_until(int64_t ns) noexcept = 0;
  /// Where the device owns time: a sample has come that was due then.
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

/// Of a device in a simulation, whose time cannot be seen: every sample counts as punctual.
class SimulatedClock final : public Clock {
 public:
  int64_t now_ns() noexcept override { return now_; }
  void sleep_until(int64_t ns) noexcept override { now_ = ns; }
  void sampled(int64_t due_ns) noexcept override { now_ = due_ns; }

 private:
  int64_t now_ = 0;
};

}  // namespace loopwright::hw
