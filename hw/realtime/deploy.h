/// Runs a plan on hardware: the loop, its statistics, its log, and a safe end.
#pragma once
#include <functional>
#include "engine/record/recording.h"
#include "engine/run/simulation.h"
#include "hw/device/io_device.h"
#include "hw/realtime/axes.h"
#include "hw/realtime/clock.h"
#include "hw/realtime/histogram.h"
#include "hw/realtime/system.h"

namespace loopwright::hw {

/// Values for the live display.
struct LiveValues {
  double time = 0, stop = 0, error = 0, command = 0, lateness_s = 0;
  bool has_error = false;
};

struct DeployOptions {
  SystemRequest system;
  bool require_real_time = false;  ///< refuse to move anything unless all of `system` is granted
  /// The log while it grows, see engine/record/journal.h: a file that must not exist yet. Empty: rows are
  /// kept in memory.
  std::string journal;
  bool keeps_log = true;  ///< false: without a journal no row is kept
  size_t ring_bytes =
      32u << 20;  ///< at most, between loop and log; rows that do not fit are dropped and counted
  size_t memory_bytes = 256u << 20;  ///< at most, for a log in memory; later rows are dropped and counted
  /// s; 0: ten periods, at least 0.25 s; 5 s in simulated time. A longer read, write or block ends the run.
  double read_timeout = 0;
  /// s, beside the time that the driver may wait for its device: if a stop lasts longer, the process ends.
  double end_timeout = 10;
  Clock* clock = nullptr;  ///< null: the computer's clock, or the simulated one if the device asks for it
  std::function<void(const LiveValues&)> progress;  ///< called a few times a second, not in the loop
  /// Lines about device and system, when the device is open and nothing has been output yet.
  std::function<void(const std::vector<std::string>&)> ready;
  void (*loop_begins)() = nullptr;  ///< in the loop's thread, before the first and after the last cycle
  void (*loop_ends)() = nullptr;
};

struct BlockTime {
  std::string path;
  double mean_us = 0, longest_us = 0;
};

struct LoopStatistics {
  int64_t cycles = 0;
  int64_t overruns = 0;  ///< commands sent after the next sample was due
  int64_t most_overruns_in_row = 0;
  int64_t lost_samples = 0;     ///< between the first and the last sample that the loop read
  int64_t skipped_periods = 0;  ///< skipped by the computer's clock
  int64_t longest_gap = 0;      ///< consecutive instants without a sample
  int64_t longest_backlog = 0;  ///< periods that a sample waited
  int64_t glitches = 0, clamped = 0, rate_limited = 0;
  int64_t dropped_rows = 0;            ///< of the log, because the disk was too slow
  double longest_log_delay_s = 0;      ///< that a row waited before it was passed to the system
  double least_watchdog_margin_s = 0;  ///< timeout minus the longest time between reloads; 0: no watchdog
  Histogram lateness, read, step, write, total;
  std::vector<BlockTime> blocks;  ///< slowest first
};

/// How the log ended.
enum class LogEnd : uint8_t {
  whole,
  failed,  ///< the disk rejected it from some row on
  stalled  ///< the disk does not respond: a thread still waits for it
};

struct DeployResult {
  RunStatus status = RunStatus::finished;
  std::string message;  ///< why it did not finish
  double time = 0;      ///< [s] time that it reached
  OutputsSafe outputs_safe = OutputsSafe::unknown;
  Status fault;
  /// One row per period: the plan's logged signals, then each axis, then the loop's statistics. Without rows
  /// if there is a journal.
  Recording recording;
  LogEnd log = LogEnd::whole;
  LoopStatistics statistics;
  SystemReport system;
  std::vector<std::string> device;
};

/// Runs the plan from start to stop on a closed device, in a thread of its own.
///
/// In every case safe values are sent and the device is closed: at the plan's end, at a fault, at any signal
/// that requests the end (stop_signals.h), when a callback throws, when the log cannot be written, and when
/// the process crashes (crash_guard.h). While the loop hangs in a call of the driver or in a block, another
/// thread sends the safe values (rescue.h). If the call never returns, the process ends, with exit code 1 or
/// by the signal that requested the end: after `end_timeout`, or at a second signal 2 s after the first.
/// After SIGKILL or a power failure, which no process survives, and if the driver lets no other call through,
/// only the device's watchdog acts. Throws only before the device is opened: when threads or the journal
/// cannot be created.
DeployResult deploy(const Plan& plan, const Hardware& hardware, IoDevice& device,
                    const DeployOptions& options = {});

/// The loop's own columns in a recording.
inline constexpr std::string_view lateness_column = "loop.lateness", step_column = "loop.step_time",
                                  lost_column = "loop.lost";

}  // namespace loopwright::hw
