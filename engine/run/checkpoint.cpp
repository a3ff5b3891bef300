#include "engine/run/checkpoint.h"
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include "engine/record/atomic_file.h"
#include "engine/record/hash.h"

namespace loopwright {
namespace {

constexpr std::string_view magic = "loopwright checkpoint 2\n";

struct Header {
  char plan_hash[16];
  uint64_t seed;
  int64_t run, tick;
  double time;
  uint64_t arena_bytes, solver_bytes, columns, rows;
};

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
  Header header{};
  std::memcpy(header.plan_hash, run.plan().hash.data(), 16);
  header.seed = identity.seed, header.run = identity.run, header.tick = run.now().tick;
  header.time = run.now().time;
  header.arena_bytes = run.arena().size(), header.solver_bytes = solver.size();
  header.columns = recorder.recording().columns.size(), header.rows = uint64_t(recorder.rows());
  std::string bytes(magic);
  append(bytes, &header, sizeof header);
  append(bytes, run.arena().data(), run.arena().size());
  bytes += solver;
  for (const Column& column : recorder.recording().columns)
    append(bytes, column.values.data(), column.values.size() * sizeof(double));
  bytes += content_hash(bytes);
  write_file(path, bytes);
}

std::string read_checkpoint(const std::string& path, Run<double>& run, RunIdentity& identity,
                            Recorder& recorder) {
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(path, "the checkpoint cannot be read", "is the path right?");
  std::stringstream stream;
  stream << file.rdbuf();
  const std::string bytes = stream.str();
  Header header;
  if (bytes.size() < magic.size() + sizeof header + 16 || !bytes.starts_with(magic))
    refuse(path, "this is not a checkpoint of this version", "");
  if (content_hash(std::string_view(bytes).substr(0, bytes.size() - 16)) != bytes.substr(bytes.size() - 16))
    refuse(path, "the checkpoint is damaged", "start the run anew");
  std::memcpy(&header, bytes.data() + magic.size(), sizeof header);
  const Plan& plan = run.plan();
  if (std::string_view(header.plan_hash, 16) != plan.hash || header.arena_bytes != run.arena().size() ||
      header.columns != recorder.recording().columns.size())
    refuse(path,
           fmt::format("the checkpoint belongs to another diagram or other parameters (plan {}, here {})",
                       std::string_view(header.plan_hash, 16), plan.hash),
           "run the same diagram with the same --set and --variant as when it was written");
  const char* at = bytes.data() + magic.size() + sizeof header;
  if (bytes.size() != size_t(at - bytes.data()) + header.arena_bytes + header.solver_bytes +
                          header.columns * header.rows * sizeof(double) + 16)
    refuse(path, "the checkpoint is damaged", "start the run anew");
  identity = {header.seed, header.run};
  run.reset(identity);
  std::memcpy(run.arena().data(), at, header.arena_bytes);
  run.restored({header.time, header.tick});
  at += header.arena_bytes;
  std::string solver(at, header.solver_bytes);
  at += header.solver_bytes;
  for (Column& column : recorder.recording().columns) {
    column.values.resize(header.rows);
    std::memcpy(column.values.data(), at, header.rows * sizeof(double));
    at += header.rows * sizeof(double);
  }
  return solver;
}

}  // namespace loopwright
