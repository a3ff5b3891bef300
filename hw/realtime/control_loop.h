/// The loop itself: runs every cycle in the real-time thread and keeps its statistics.
#pragma once
#include "hw/realtime/deploy.h"
#include "hw/realtime/log_columns.h"
#include "hw/realtime/log_ring.h"
#include "hw/realtime/period.h"

namespace loopwright::hw {

/// Where the loop is: each part has to end within a time.
enum class LoopPart : uint8_t { none, start, read, step, write };

/// How the loop ended.
struct LoopEnd {
  enum class Why : uint8_t { running, finished, asked, status, step_failed, overruns, lost, skipped };
  Why why = Why::running;
  Status status;
};

class ControlLoop {
 public:
  ControlLoop(const Plan& plan, const Hardware& hardware, IoDevice& device, Clock& clock, LogRing& log,
              std::span<const LogColumn> columns);

  /// Two steps at rest with discarded outputs, so that code and memory are warm at the first real step.
  void warm_up();
  /// Runs cycles until the plan's stop, a fault, or request_stop(). The outputs keep their values.
  void run() noexcept;
  /// Starts the device, as a part of the loop: it sends the initial values.
  Status start();
  /// The present cycle is the last one. From any thread; a read that waits is not woken.
  void request_stop() noexcept { is_asked_to_stop_.store(true, std::memory_order_relaxed); }
  /// The part in which the loop is, and for how long; of a step, how long its present block takes.
  struct Progress {
    LoopPart part = LoopPart::none;
    int64_t for_ns = 0;
  };
  Progress progress() const noexcept {
    const LoopPart part = part_.load(std::memory_order_acquire);
    if (part == LoopPart::none) return {};
    return {part, wall_ns() - part_since_.load(std::memory_order_relaxed)};
  }
  LiveValues live() const noexcept;

  const LoopEnd& end() const { return end_; }
  const PeriodStepper& stepper() const { return stepper_; }
  LoopStatistics statistics() const;

 private:
  struct BlockSum {
    int64_t total_ns = 0, longest_ns = 0;
  };
  /// In this order: who sees the new part does not see an older time with it.
  void enter(LoopPart part, int64_t now) noexcept {
    part_since_.store(now, std::memory_order_relaxed);
    part_.store(part, std::memory_order_release);
  }
  /// In no part that is watched.
  void leave() noexcept { part_.store(LoopPart::none, std::memory_order_release); }
  bool cycle() noexcept;
  Status read(Sample& sample) noexcept;
  int64_t lateness_of(const Sample& sample) noexcept;
  /// Counts the instants without a sample. False: too many in a row, or the run ends among them.
  bool count_missing(const Sample& sample) noexcept;
  bool step() noexcept;
  Status write() noexcept;
  bool account_for(int64_t lateness_ns, int64_t step_ns) noexcept;
  void wait_for_log() noexcept;
  bool end_with(LoopEnd::Why why, Status status = {}) noexcept {
    end_ = {why, status};
    return false;
  }

  const Hardware& hardware_;
  IoDevice& device_;
  Clock& clock_;
  LogRing& log_;
  std::span<const LogColumn> columns_;
  PeriodStepper stepper_;
  const bool device_is_clock_, is_simulated_;
  const int64_t period_ns_;
  std::vector<double> inputs_, outputs_, row_;
  std::vector<BlockSum> block_sums_;
  Number error_ = -1;  // for the live view

  LoopEnd end_;
  LoopStatistics statistics_;
  int64_t origin_ns_ = 0, due_ns_ = 0, kicked_ns_ = 0, longest_unkicked_ns_ = 0;
  int64_t instant_ = 0;  ///< of the sample, in periods since the first one
  int64_t skipped_ = 0;  ///< periods before this sample that the computer's clock skipped
  int64_t missing_ = 0;  ///< instants before this sample without one
  int64_t overruns_in_row_ = 0;
  std::atomic<bool> is_asked_to_stop_ = false;
  std::atomic<LoopPart> part_ = LoopPart::none;
  std::atomic<int64_t> part_since_ = 0;
  std::atomic<double> live_time_ = 0, live_error_ = 0, live_command_ = 0, live_lateness_ = 0;
};

}  // namespace loopwright::hw
