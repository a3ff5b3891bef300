/// Accidents in a deployment: crashes, and a driver in which one happens.
#pragma once
#include <sys/mman.h>
#include <unistd.h>
#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include "hw/device/driver.h"

namespace loopwright::hw::ends_test {

inline volatile int zero = 0;
inline volatile int* volatile nowhere = nullptr;
[[gnu::noinline]] inline int endless(int n) {
  volatile char frame[4096];
  frame[0] = char(n);
  frame[1] = char(n);
  if (n == zero) return 0;  // never
  return frame[0] + endless(n + 1) + frame[1];
}
inline void access_beyond_the_end_of_a_file() {
  const int file = memfd_create("short", 0);
  if (ftruncate(file, 1) != 0) abort();
  auto* page = static_cast<volatile char*>(mmap(nullptr, 8192, PROT_READ, MAP_SHARED, file, 0));
  zero = page[4096];
}
/// The processor must see these crashes, not the sanitizer.
__attribute__((no_sanitize("undefined"))) inline void crash(const std::string& how) {
  if (how == "null pointer") *nowhere = 1;
  if (how == "division by zero") zero = 7 / zero;
  if (how == "illegal instruction") __builtin_trap();
  if (how == "abort") abort();
  if (how == "terminate") std::terminate();
  if (how == "stack overflow") zero = endless(1);
  if (how == "bus error") access_beyond_the_end_of_a_file();
  if (how == "exit") exit(3);
  if (how == "exception") throw std::runtime_error("thrown on purpose");
  if (how == "wrong exception") throw 17;
}

/// The card's driver, with an injected failure: after 500 samples a crash in the loop's thread, or calls that
/// hang from then on: "hang in read, request_stop". "slow in write": one call lasts for a second.
class AccidentDriver final : public Driver {
 public:
  AccidentDriver(std::unique_ptr<Driver> driver, std::string how)
      : driver_(std::move(driver)), how_(std::move(how)) {}
  Capabilities capabilities() const override { return driver_->capabilities(); }
  Status open() override { return driver_->open(); }
  Status configure(std::span<const double> safe) override { return driver_->configure(safe); }
  Status start(double period_s) override { return driver_->start(period_s); }
  std::string describe(Status status) const override { return driver_->describe(status); }
  Status read(RawSample& sample, std::span<double> raw) noexcept override {
    if (++reads_ > 500) {
      crash(how_);
      accident_in("read");
    }
    return driver_->read(sample, raw);
  }
  Status write(std::span<const double> raw) noexcept override {
    accident_in("write");
    return driver_->write(raw);
  }
  Status kick() noexcept override { return driver_->kick(); }
  void request_stop() noexcept override {
    accident_in("request_stop");
    driver_->request_stop();
  }
  void emergency_stop(std::span<const double> safe) noexcept override {
    accident_in("emergency_stop");
    driver_->emergency_stop(safe);
  }
  void stop_sampling() noexcept override {
    accident_in("end of sampling");
    driver_->stop_sampling();
  }
  void disarm() noexcept override { driver_->disarm(); }
  bool watchdog_took_over() noexcept override { return driver_->watchdog_took_over(); }
  void close() noexcept override {
    accident_in("close");
    driver_->close();
  }
  Status rearm() override { return driver_->rearm(); }

 private:
  void accident_in(const char* call) noexcept {
    using namespace std::chrono_literals;
    if (reads_ <= 500 || how_.find(call) == how_.npos) return;
    while (how_.starts_with("hang")) std::this_thread::sleep_for(1s);
    if (how_.starts_with("slow") && !has_been_slow_.exchange(true)) std::this_thread::sleep_for(1s);
  }

  std::unique_ptr<Driver> driver_;
  std::string how_;
  std::atomic<int> reads_ = 0;
  std::atomic<bool> has_been_slow_ = false;
};

}  // namespace loopwright::hw::ends_test
