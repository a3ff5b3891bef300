#include "tools/sweep/run_sweep.h"
#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <new>
#include <stdexcept>
#include <thread>
#include "engine/file/regular_file.h"
#include "engine/record/atomic_file.h"
#include "tools/sweep/lane_group.h"

namespace loopwright {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Contains the path of the sweep file, and then the facts of the identity of the results.
constexpr const char* name_of_sweep_file = "sweep_file.txt";

/// The first line of the file, and the facts below it.
std::pair<std::string, Facts> read_sweep_file(const std::string& folder) {
  std::string text;
  if (!read_regular_file(folder + '/' + name_of_sweep_file, size_t(1) << 26, text).empty()) return {};
  const size_t end = std::min(text.find('\n'), text.size());
  return {text.substr(0, end), facts_of(std::string_view(text).substr(std::min(end + 1, text.size())))};
}

[[noreturn]] void refuse_foreign(const SweepPlan& plan, const std::string& folder, const std::string& path,
                                 const ShardState& state) {
  std::string message = fmt::format("{}: {}", path, state.problem);
  const Identity before = identity_of(read_sweep_file(folder).second);
  if (!before.structure.empty() && before.hash() != plan.hash())
    message += ": " + changes_with_build(before, plan.identity());
  throw std::runtime_error(message);
}

/// Blocks of all worlds, one after the other; a block never spans two worlds.
struct Blocks {
  explicit Blocks(const SweepDesign& design)
      : in_block(runs_in_block(design)),
        in_world((design.runs_in_world() + in_block - 1) / in_block),
        runs_in_world(design.runs_in_world()),
        count(in_world * design.worlds()) {}
  std::pair<int64_t, int64_t> runs(int64_t block) const {
    const int64_t world = block / in_world * runs_in_world, inside = block % in_world * in_block;
    return {world + inside, world + std::min(inside + in_block, runs_in_world)};
  }
  int64_t in_block, in_world, runs_in_world, count;
};

std::vector<bool> runs_in_folder(const SweepPlan& plan, const std::string& folder,
                                 std::vector<std::string>& notes) {
  std::vector<bool> done(size_t(plan.runs()));
  for (const std::string& path : shard_files(folder)) {
    const ShardState state =
        read_shard(path, plan.hash(), plan.sweep().metrics.size(), [&](const RunRecord& record) {
          if (record.run >= 0 && record.run < plan.runs()) done[size_t(record.run)] = true;
        });
    if (!state.is_readable) refuse_foreign(plan, folder, path, state);
    if (state.damaged_bytes)
      notes.push_back(
          fmt::format("{}: {} bytes are damaged; their runs are made again", path, state.damaged_bytes));
    if (state.torn_bytes)
      notes.push_back(fmt::format("{}: the last record is torn off; its run is made again", path));
  }
  return done;
}

/// State shared by the threads of one process.
class Crew {
 public:
  Crew(const SweepPlan& plan, const SweepOptions& options, ShardWriter& writer, std::vector<bool> done)
      : plan_(plan), options_(options), blocks_(plan.design()), writer_(writer), done_(std::move(done)) {
    next_ = options.shard;
    for (int64_t block = 0; block < blocks_.count; ++block)
      if (options.next_block || block % options.shards == options.shard) {
        const auto [first, end] = blocks_.runs(block);
        outcome_.runs += end - first;
        outcome_.done += std::count(done_.begin() + first, done_.begin() + end, true);
      }
  }

  SweepOutcome work() {
    std::vector<std::thread> threads;
    for (int i = 1; i < options_.threads; ++i) threads.emplace_back([this] { take_blocks(); });
    take_blocks();
    for (std::thread& thread : threads) thread.join();
    if (!problem_.empty()) throw std::runtime_error(problem_);
    writer_.flush();
    return outcome_;
  }

 private:
  void take_blocks() {
    try {
      LaneGroup group(plan_, options_.instruction_set);
      for (;;) {
        const int64_t block = next_block();
        if (block >= blocks_.count) return;
        const auto [first, end] = blocks_.runs(block);
        if (std::find(done_.begin() + first, done_.begin() + end, false) == done_.begin() + end) continue;
        hand_in(group.make(first, end));
      }
    } catch (const std::bad_alloc&) {
      end_with("the runs need more memory than there is: fewer threads need less");
    } catch (const std::exception& error) {
      end_with(error.what());
    }
  }
  void end_with(std::string problem) {
    const std::lock_guard lock(mutex_);
    if (problem_.empty()) problem_ = std::move(problem);
  }
  int64_t next_block() {
    const std::lock_guard lock(mutex_);
    if (options_.interrupt && options_.interrupt->load(std::memory_order_relaxed))
      outcome_.interrupted = true;
    if (outcome_.interrupted || !problem_.empty()) return blocks_.count;
    if (options_.next_block) return options_.next_block();
    const int64_t block = next_;
    next_ += options_.shards;
    return block;
  }
  void hand_in(std::vector<RunRecord> records) {
    const std::lock_guard lock(mutex_);
    std::erase_if(records, [&](const RunRecord& record) { return done_[size_t(record.run)]; });
    writer_.append(records);
    for (const RunRecord& record : records) outcome_.failed += record.failed;
    outcome_.made += int64_t(records.size()), outcome_.done += int64_t(records.size());
    if (const auto now = Clock::now(); now - flushed_ > std::chrono::seconds(2)) {
      writer_.flush();
      flushed_ = now;
    }
    if (options_.progress) options_.progress(outcome_.done, outcome_.runs);
  }

  const SweepPlan& plan_;
  const SweepOptions& options_;
  const Blocks blocks_;
  ShardWriter& writer_;
  const std::vector<bool> done_;  // before this call
  std::mutex mutex_;
  int64_t next_ = 0;
  Clock::time_point flushed_ = Clock::now();
  SweepOutcome outcome_;
  std::string problem_;
};

/// The column of an axis: numbers as written in the file; variants by their index.
Column axis_column(const Axis& axis) {
  return {axis.name, axis.kind == Axis::Kind::variants ? "" : axis.unit, {}};
}

}  // namespace

std::vector<std::string> shard_files(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(folder, code))
    if (entry.path().extension() == ".shard") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

/// Relative to the present folder if below it: commands and pages that name it must also work elsewhere.
static std::string from_here(const std::string& path) {
  std::error_code code;
  const std::string relative = fs::path(path).lexically_relative(fs::current_path(code)).string();
  return code || relative.empty() || relative.starts_with("..") ? path : relative;
}

std::string sweep_file_of(const std::string& folder) {
  if (const std::string path = read_sweep_file(folder).first; !path.empty()) return from_here(path);
  Problems problems;
  problems.error({}, "", "", fmt::format("\"{}\" holds no results of a sweep", folder)).expected =
      "the folder that was given to `loopwright sweep … -o`";
  throw InputError(std::move(problems));
}

SweepOutcome run_sweep(const SweepPlan& plan, const std::string& folder, const SweepOptions& options) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) throw std::runtime_error(fmt::format("{}: cannot be made: {}", folder, code.message()));
  const std::string file =
      fmt::format("{}/runs_{}_of_{}_{}.shard", folder, options.shard, options.shards, options.writer);
  if (!options.resume)
    for (const std::string& path : shard_files(folder)) {
      if ((options.shards == 1 && !options.next_block) || path == file)
        throw std::runtime_error(fmt::format(
            "{} holds results already: --resume goes on with them, another folder starts anew", path));
      if (const ShardState state = read_head_of_shard(path, plan.hash(), plan.sweep().metrics.size());
          !state.is_readable)
        refuse_foreign(plan, folder, path, state);
    }
  std::vector<std::string> notes;
  auto done = options.resume ? runs_in_folder(plan, folder, notes) : std::vector<bool>(size_t(plan.runs()));
  if (options.all_have_read) options.all_have_read();
  ShardWriter writer(file, plan.hash(), plan.sweep().metrics.size());
  write_file(folder + '/' + name_of_sweep_file,
             fs::absolute(plan.sweep().path).string() + "\n" + to_text(plan.identity().facts()));
  SweepOutcome outcome = Crew(plan, options, writer, std::move(done)).work();
  for (int64_t w = 0; w < plan.design().worlds(); ++w)
    if (const World& world = plan.world(w); !world.lanes_forbidden.empty() && notes.size() < 5)
      notes.push_back(fmt::format("runs go one by one: {}", world.lanes_forbidden));
  outcome.notes = std::move(notes);
  return outcome;
}

std::vector<RunRecord> make_runs(const SweepPlan& plan, int64_t first, int64_t end,
                                 std::optional<InstructionSet> set) {
  return LaneGroup(plan, set).make(first, end);
}

/// For the results in a folder. Results of another build of the program are also read, with a notice, because
/// nothing is added to them.
Identity identity_of_results(const SweepPlan& plan, const std::string& folder,
                             std::vector<std::string>& notes) {
  Identity before = identity_of(read_sweep_file(folder).second);
  if (before.build == plan.identity().build || !changes(before, plan.identity()).empty())
    return plan.identity();
  notes.push_back(fmt::format("the results were made by another build of the program ({}, here {})",
                              before.build, plan.identity().build));
  return before;
}

SweepResults read_results(const SweepPlan& plan, const std::string& folder) {
  const Sweep& sweep = plan.sweep();
  const size_t axes = sweep.axes.size(), metrics = sweep.metrics.size();
  SweepResults results;
  const Identity identity = identity_of_results(plan, folder, results.notes);
  const std::string hash = identity.hash();
  auto& columns = results.table.columns;
  columns.push_back({"run", "", {}});
  for (const Axis& axis : sweep.axes) columns.push_back(axis_column(axis));
  for (size_t m = 0; m < metrics; ++m)
    columns.push_back({sweep.metrics[m].name, plan.world(0).observed.units[m], {}});
  columns.push_back({"failed", "", {}});
  columns.push_back({"stopped_at", "s", {}});

  // A column has an entry for every run from the start: shards bring the runs in any order.
  const size_t runs = size_t(plan.runs()), failed_column = 1 + axes + metrics;
  for (size_t c = 1 + axes; c < columns.size(); ++c) columns[c].values.assign(runs, std::nan(""));
  for (const std::string& path : shard_files(folder)) {
    const ShardState state = read_shard(path, hash, metrics, [&](const RunRecord& record) {
      const size_t at = size_t(record.run);
      if (at >= runs || !std::isnan(columns[failed_column].values[at])) return;  // the same bits again
      for (size_t m = 0; m < metrics; ++m) columns[1 + axes + m].values[at] = record.metrics[m];
      columns[failed_column].values[at] = record.failed;
      columns[failed_column + 1].values[at] = record.stopped_at;
      if (record.failed) results.failures.emplace_back(record.run, record.reason);
    });
    if (!state.is_readable) refuse_foreign(plan, folder, path, state);
    if (state.damaged_bytes || state.torn_bytes)
      results.notes.push_back(
          fmt::format("{}: {} bytes are damaged or torn off", path, state.damaged_bytes + state.torn_bytes));
  }
  std::sort(results.failures.begin(), results.failures.end());

  size_t kept = 0;
  for (size_t run = 0; run < runs; ++run) {
    if (std::isnan(columns[failed_column].values[run])) continue;
    const auto point = plan.design().point(int64_t(run));
    columns[0].values.push_back(double(run));
    for (size_t a = 0; a < axes; ++a) columns[1 + a].values.push_back(point[a]);
    for (size_t c = 1 + axes; c < columns.size(); ++c) columns[c].values[kept] = columns[c].values[run];
    ++kept;
  }
  for (size_t c = 1 + axes; c < columns.size(); ++c) columns[c].values.resize(kept);
  results.missing = int64_t(runs - kept);
  auto& facts = results.table.facts;
  facts.emplace_back("title", sweep.title);
  facts.emplace_back("sweep", hash);
  for (auto& [name, value] : identity.facts())
    if (name != "plan") facts.emplace_back(name, value);
  for (const Axis& axis : sweep.axes)
    for (size_t v = 0; v < axis.variants.size(); ++v)
      facts.emplace_back(fmt::format("{} {}", axis.name, v), axis.variants[v]);
  return results;
}

}  // namespace loopwright
