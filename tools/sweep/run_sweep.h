/// Makes the runs of a sweep: on lanes, on threads, in parts on several machines, and on from where it
/// stopped. A result depends on the run alone, never on who made it, beside whom, or when.
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

/// Runs are handed out in blocks; each is made by one thread. Lanes of two arenas in turn wait less for each
/// other's results than those of one; but with few runs, large blocks would leave threads without work.
inline int64_t runs_in_block(const Design& design) { return design.runs_in_world() < 1024 ? 32 : 64; }

struct SweepOptions {
  int threads = 1;
  std::optional<InstructionSet> instruction_set;  ///< nothing: the widest that runs here
  bool resume = false;                            ///< go on with the results in the folder
  int64_t shard = 0, shards = 1;                  ///< this part of so many
  std::string writer = "0";                       ///< tells the files of processes in one folder apart
  /// The next block, shared between processes; empty: every block of this shard in order.
  std::function<int64_t()> next_block;
  std::function<void()>
      all_have_read;  ///< called before the first run; comes back when every process is there
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(int64_t done, int64_t total)> progress;
};

struct SweepOutcome {
  int64_t runs = 0;    ///< of this shard
  int64_t done = 0;    ///< with results in the folder, made now or before
  int64_t made = 0;    ///< now
  int64_t failed = 0;  ///< of those made now
  bool interrupted = false;
  std::vector<std::string> notes;  ///< damaged or torn records, runs off lanes
};

/// Results go to files `*.shard` in the folder, which is made. Throws std::runtime_error when the folder
/// holds other results, is in use or cannot be written; what was appended by then stays.
SweepOutcome run_sweep(const SweepPlan& plan, const std::string& folder, const SweepOptions& options);

/// One group of runs [first, end) of one world, at most a block.
std::vector<RunRecord> make_runs(const SweepPlan& plan, int64_t first, int64_t end,
                                 std::optional<InstructionSet> set = {});

/// All results in a folder by their run: number, axes, metrics, whether it failed, when it stopped. Runs
/// without a result are left out. Throws std::runtime_error when a shard is not of this sweep.
struct SweepResults {
  Recording table;
  std::vector<std::pair<int64_t, std::string>> failures;  ///< run and reason
  int64_t missing = 0;
  std::vector<std::string> notes;
};
SweepResults read_results(const SweepPlan& plan, const std::string& folder);

/// Where the sweep file of a folder of results lies. Throws InputError when it is no such folder.
std::string sweep_file_of(const std::string& folder);

/// The shards in a folder, sorted.
std::vector<std::string> shard_files(const std::string& folder);

}  // namespace loopwright
