#include "engine/run/checkpoint.h"
#include <fmt/format.h>
#include <cstring>
#include <limits>
#include "engine/file/hash.h"
#include "engine/file/regular_file.h"
#include "engine/record/atomic_file.h"

namespace loopwright {
namespace {

constexpr std::string_view magic = "loopwright checkpoint 2\n";

/// Followed by the facts of the plan's identity, the arena, the rows of each column, and the hash of
/// everything.
struct Header {
  uint64_t seed;
  int64_t run, tick;
  double time;
  uint64_t facts_bytes, arena_bytes, solver_bytes, columns, rows;
};
constexpr size_t hash_bytes = 16;

void append(std::string& to, const void* data, size_t bytes) {
  to.append(static_cast<const char*>(data), bytes);
}

[[noreturn]] void refuse(const std::string& path, std::string message, std::string hint) {
  Problems problems;
  auto& p = problems.error({}, "", "", fmt::format("{}: {}", path, message));
  p.hint = std::move(hint);
  throw InputError(std::move(problems));
}

}  // namespace

void write_checkpoint(const std::string& path, Run<double>& run, const RunIdentity& identity,
                      const std::string& solver, Recorder& recorder) {
  const std::string facts = to_text(run.plan().identity.facts());
  Header header{};
  header.seed = identity.seed, header.run = identity.run, header.tick = run.now().tick;
  header.time = run.now().time;
  header.facts_bytes = facts.size(), header.arena_bytes = run.arena().size();
  header.solver_bytes = solver.size();
  header.columns = recorder.recording().columns.size(), header.rows = uint64_t(recorder.rows());
  std::string bytes(magic);
  append(bytes, &header, sizeof header);
  bytes += facts;
  append(bytes, run.arena().data(), run.arena().size());
  bytes += solver;
  for (const Column& column : recorder.recording().columns)
    append(bytes, column.values.data(), column.values.size() * sizeof(double));
  bytes += content_hash(bytes);
  write_file(path, bytes);
}

std::string read_checkpoint(const std::string& path, Run<double>& run, RunIdentity& identity,
                            Recorder& recorder) {
  std::string bytes;
  const std::string reason = read_regular_file(path, std::numeric_limits<int64_t>::max(), bytes);
  if (!reason.empty()) refuse(path, "the checkpoint cannot be read: " + reason, "is the path right?");
  std::string_view left = bytes;
  Header header;
  if (left.size() < magic.size() + sizeof header + hash_bytes || !left.starts_with(magic))
    refuse(path, "this is not a checkpoint of this version", "");
  const std::string_view hash = left.substr(left.size() - hash_bytes);
  left.remove_suffix(hash_bytes);
  if (content_hash(left) != hash) refuse(path, "the checkpoint is damaged", "start the run anew");
  std::memcpy(&header, left.data() + magic.size(), sizeof header);
  left.remove_prefix(magic.size() + sizeof header);
  // The hash is valid, so these lengths are as written. They are still checked before reading.
  const auto take = [&](size_t length) {
    if (length > left.size()) refuse(path, "the checkpoint is damaged", "start the run anew");
    const std::string_view part = left.substr(0, length);
    left.remove_prefix(length);
    return part;
  };
  const Plan& plan = run.plan();
  const Identity before = identity_of(facts_of(take(header.facts_bytes)));
  if (before.hash() != plan.hash)
    refuse(path, "the checkpoint belongs to something else: " + changes_with_build(before, plan.identity),
           "a run goes on only with the same diagram, --set and --variant, files and program");
  if (header.tick < plan.start_tick || header.tick > plan.stop_tick ||
      header.arena_bytes != run.arena().size() || header.columns != recorder.recording().columns.size())
    refuse(path, "the checkpoint is damaged", "start the run anew");
  const std::string_view arena = take(header.arena_bytes);
  std::string solver(take(header.solver_bytes));
  if (header.columns > 0 && header.rows != left.size() / header.columns / sizeof(double))
    refuse(path, "the checkpoint is damaged", "start the run anew");
  identity = {header.seed, header.run};
  run.reset(identity);
  std::memcpy(run.arena().data(), arena.data(), arena.size());
  run.restored({header.time, header.tick});
  for (Column& column : recorder.recording().columns) {
    const std::string_view rows = take(header.rows * sizeof(double));
    column.values.resize(header.rows);
    std::memcpy(column.values.data(), rows.data(), rows.size());
  }
  return solver;
}

}  // namespace loopwright
