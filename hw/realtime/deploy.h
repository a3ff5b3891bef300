/// A plan on hardware: the loop, its accounts, its log, and a safe end.
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

/// What a person who watches wants to see.
struct LiveValues {
  double time = 0, stop = 0, error = 0, command = 0, lateness_s = 0;
  bool has_error = false;
};

struct DeployOptions {
  SystemRequest system;
  bool require_real_time = false;  ///< refuse to move anything unless all of `system` is granted
  size_t log_bytes =
      256u << 20;          ///< at most, of the ring between loop and log; the whole run where that fits
  bool drains_log = true;  ///< off: rows are only taken out at the end
  double read_timeout =
      0;  ///< s; 0: ten periods, at least 0.25 s; 5 s in simulated time. A longer read is asked to stop
  Clock* clock = nullptr;  ///< null: the computer's, or the simulation's where the device says so
  std::function<void(const LiveValues&)> progress;  ///< called a few times a second, not in the loop
  std::function<void(const std::vector<std::string>&)>
      ready;                        ///< lines about device and system, before it moves
  void (*loop_begins)() = nullptr;  ///< in the loop's thread, before the first and after the last cycle
  void (*loop_ends)() = nullptr;
};

struct BlockTime {
  std::string path;
  double mean_us = 0, longest_us = 0;
};

struct LoopStatistics {
  int64_t cycles = 0;
  int64_t overruns = 0;  ///< commands that came after the next sample was due
  int64_t most_overruns_in_row = 0;
  int64_t lost_samples = 0;     ///< between the first and the last that the loop read
  int64_t skipped_periods = 0;  ///< left out by the computer's clock
  int64_t longest_gap = 0;      ///< instants in a row without a sample
  int64_t longest_backlog = 0;  ///< periods that a sample had waited
  int64_t glitches = 0, clamped = 0, rate_limited = 0;
  int64_t dropped_rows = 0;  ///< of the log
  double least_watchdog_margin_s =
      0;  ///< timeout less the longest time between signs of life; 0: no watchdog
  Histogram lateness, read, step, write, total;
  std::vector<BlockTime> blocks;  ///< slowest first
};

struct DeployResult {
  RunStatus status = RunStatus::finished;
  std::string message;  ///< why it did not finish
  double time = 0;      ///< [s] how far it came
  OutputsSafe outputs_safe = OutputsSafe::unknown;
  Status fault;
  Recording recording;  ///< one row a period: what the plan logs, then what each axis did, then the accounts
  LoopStatistics statistics;
  SystemReport system;
  std::vector<std::string> device;
};

/// Runs the plan from start to stop on an opened or closed device, in a thread of its own. SIGINT, SIGTERM
/// and SIGHUP end it within a period. Whatever happens, the device is stopped and closed at the end.
DeployResult deploy(const Plan& plan, const Hardware& hardware, IoDevice& device,
                    const DeployOptions& options = {});

/// The loop's own columns in a recording.
inline constexpr std::string_view lateness_column = "loop.lateness", step_column = "loop.step_time",
                                  lost_column = "loop.lost";

}  // namespace loopwright::hw
