/// Makes the runs of a sweep: on lanes, on threads, in parts on several machines, and continuing after an
/// interruption. A result depends only on the run, never on which process made it, with which other runs, or
/// when.
#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include "engine/lanes/lane_run.h"
#include "engine/record/recording.h"
#include "tools/sweep/shard.h"
#include "tools/sweep/sweep_plan.h"

namespace loopwright {

/// Runs are assigned in blocks; each block is made by one thread. Alternating between the lanes of two arenas
/// reduces waiting for results; but with few runs, large blocks would leave threads without work.
inline int64_t runs_in_block(const SweepDesign& design) { return design.runs_in_world() < 1024 ? 32 : 64; }

struct SweepOptions {
  int threads = 1;
  std::optional<InstructionSet> instruction_set;  ///< empty: the widest that this machine supports
  bool resume = false;                            ///< continue with the results in the folder
  int64_t shard = 0, shards = 1;                  ///< this part of this many
  std::string writer = "0";                       ///< distinguishes the files of processes in one folder
  /// The next block, shared between processes; empty: every block of this shard in order.
  std::function<int64_t()> next_block;
  std::function<void()>
      all_have_read;  ///< called before the first run; returns when every process has arrived
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(int64_t done, int64_t total)> progress;
};

struct SweepOutcome {
  int64_t runs = 0;    ///< of this shard
  int64_t done = 0;    ///< with results in the folder, from this call or earlier
  int64_t made = 0;    ///< in this call
  int64_t failed = 0;  ///< of those made in this call
  bool interrupted = false;
  std::vector<std::string> notes;  ///< damaged or truncated records, runs not on lanes
};

/// Results are written to files `*.shard` in the folder, which is created. Throws std::runtime_error if the
/// folder contains other results, is in use or cannot be written; results appended by then are kept.
SweepOutcome run_sweep(const SweepPlan& plan, const std::string& folder, const SweepOptions& options);

/// One group of runs [first, end) of one world, at most a block.
std::vector<RunRecord> make_runs(const SweepPlan& plan, int64_t first, int64_t end,
                                 std::optional<InstructionSet> set = {});

/// All results in a folder by their run: number, axes, metrics, whether it failed, when it stopped. Runs
/// without a result are left out. Throws std::runtime_error if a shard does not belong to this sweep.
struct SweepResults {
  Recording table;
  std::vector<std::pair<int64_t, std::string>> failures;  ///< run and reason
  int64_t missing = 0;
  std::vector<std::string> notes;
};
SweepResults read_results(const SweepPlan& plan, const std::string& folder);

/// Path of the sweep file of a folder of results. Throws InputError if it is no such folder.
std::string sweep_file_of(const std::string& folder);

/// The shards in a folder, sorted.
std::vector<std::string> shard_files(const std::string& folder);

}  // namespace loopwright
