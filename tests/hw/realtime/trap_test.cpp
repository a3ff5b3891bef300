// The loop allocates nothing, throws nothing, waits for no lock, and loses no row of its log.
#include <gtest/gtest.h>
#include <cstdlib>
#include <mutex>
#include "tests/hw/deployment.h"
#include "tests/hw/realtime/trap.h"

namespace loopwright::hw::trap_test {
namespace {

/// A mass on a driver without any lock: only operations of the loop are counted.
class QuietDriver final : public Driver {
 public:
  Capabilities capabilities() const override { return {true, false, false, true}; }
  Status open() override { return {}; }
  Status configure(std::span<const double>) override { return {}; }
  Status start(double) override { return {}; }
  std::string describe(Status) const override { return ""; }
  Status read(RawSample& sample, std::span<double> raw) noexcept override {
    velocity_ += 1e-3 * (volts_ - 2.4 * velocity_) / 0.26, position_ += 1e-3 * velocity_;
    sample.sequence = sequence_++;
    raw[0] = double(int64_t(position_ / 2e-7));
    return {};
  }
  Status write(std::span<const double> raw) noexcept override { return volts_ = raw[0], Status{}; }
  Status kick() noexcept override { return {}; }
  void request_stop() noexcept override {}
  void emergency_stop(std::span<const double> safe) noexcept override { write(safe); }
  void stop_sampling() noexcept override {}
  void disarm() noexcept override {}
  bool watchdog_took_over() noexcept override { return false; }
  void close() noexcept override {}
  Status rearm() override { return {}; }

 private:
  double position_ = 0, velocity_ = 0, volts_ = 0;
  int64_t sequence_ = 0;
};

DeployOptions watched() {
  DeployOptions options;
  options.loop_begins = begin_trap, options.loop_ends = end_trap;
  take_trapped();
  return options;
}

TEST(Trap, Counts) {
  if (!can_trap()) GTEST_SKIP() << "a sanitizer brings its own allocator";
  take_trapped();
  begin_trap();
  void* volatile memory = std::malloc(1);
  std::free(memory);
  std::mutex mutex;
  { const std::lock_guard lock(mutex); }
  try {
    throw 1;
  } catch (int) {
  }
  end_trap();
  const Trapped trapped = take_trapped();
  EXPECT_GE(trapped.allocations, 1);
  EXPECT_EQ(trapped.locks, 1);
  EXPECT_EQ(trapped.exceptions, 1);
}

TEST(Trap, TheLoopAllocatesThrowsAndLocksNothing) {
  if (!can_trap()) GTEST_SKIP() << "a sanitizer brings its own allocator";
  EmulatedCard card;
  const Deployed deployed(in_virtual_time);
  IoDevice device(deployed.hardware.device, std::make_unique<QuietDriver>());
  const DeployResult result = deploy(*deployed.plan, deployed.hardware, device, watched());
  EXPECT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_EQ(result.statistics.cycles, 3101);
  const Trapped trapped = take_trapped();
  EXPECT_EQ(trapped.allocations, 0);
  EXPECT_EQ(trapped.exceptions, 0);
  EXPECT_EQ(trapped.locks, 0);
}

TEST(Trap, TenMinutesOnTheCardAllocateNothingAndLoseNoRow) {
  const double seconds = can_trap() ? 600 : 20;
  EmulatedCard card;
  LoadOptions options;
  options.set = {{"solver.stop", std::to_string(seconds)}};
  Deployed deployed(in_virtual_time, options);
  const DeployResult result = deployed.run(watched());
  EXPECT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_EQ(result.statistics.cycles, int64_t(seconds) * 1000 + 1);
  EXPECT_EQ(result.statistics.dropped_rows, 0);
  EXPECT_EQ(int64_t(result.recording.rows()), result.statistics.cycles);
  EXPECT_EQ(take_trapped().allocations, 0);
}

}  // namespace
}  // namespace loopwright::hw::trap_test
