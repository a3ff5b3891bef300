/// The memory that the program needs for one run.
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <filesystem>
#include <stdexcept>
#include <fmt/format.h>
#include "tests/benchmarks/diagram_file.h"
#include "tests/benchmarks/measure.h"

extern char** environ;

namespace loopwright::benchmarks {
namespace {

/// Peak resident memory of `program arguments…` in bytes. Throws if the program fails.
double peak_memory(std::vector<std::string> command) {
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  if (posix_spawn(&child, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0)
    throw std::runtime_error("cannot start " + command[0]);
  int status = 0;
  rusage usage{};
  if (wait4(child, &status, 0, &usage) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw std::runtime_error(command[0] + " failed");
  return 1024.0 * double(usage.ru_maxrss);
}

void common_job_memory(benchmark::State& state) {
  const std::string diagram = std::string(LOOPWRIGHT_SOURCE) + "/diagrams/linear_motor/common_job.json";
  std::vector<double> megabytes;
  for (auto _ : state) {
    const double start = cpu_time();
    megabytes.push_back(1e-6 * peak_memory({LOOPWRIGHT_PROGRAM, "run", "-q", diagram}));
    state.SetIterationTime(cpu_time() - start);
  }
  report(state, {"common_job_peak_memory_mb",
                 median(megabytes),
                 60,
                 "peak resident memory of the whole process `loopwright run` on common_job.json, from "
                 "getrusage, median",
                 {{"repetitions", double(megabytes.size())}}});
}

/// Peak memory [MB] of a whole `loopwright sweep` of a small diagram.
double sweep_memory(int runs) {
  const DiagramFile sweep(fmt::format(
      R"({{"loopwright": 1, "diagram": "{}/diagrams/linear_motor/common_job.json", "set": {{"solver.stop": 0.01}},
      "axes": {{"stage.payload": {{"uniform": {{"from": 0, "to": 0.5}}}}}}, "samples": {{"count": {}}},
      "metrics": {{"tracking": {{"rms": "error.sum"}}}}}})",
      LOOPWRIGHT_SOURCE, runs));
  const std::string folder = sweep.path() + ".results";
  const double bytes = peak_memory({LOOPWRIGHT_PROGRAM, "sweep", sweep.path(), "-o", folder});
  std::filesystem::remove_all(folder);
  return 1e-6 * bytes;
}

void sweep_memory_growth(benchmark::State& state) {
  constexpr int few = 1000, many = 100'000;
  double first = 0, last = 0;
  for (auto _ : state) {
    const double start = cpu_time();
    first = sweep_memory(few), last = sweep_memory(many);
    state.SetIterationTime(cpu_time() - start);
  }
  report(state,
         {"sweep_memory_mb",
          first + (last - first) * (1'000'000.0 - few) / (many - few),
          200,
          "peak resident memory of a sweep of a million runs, tables included, on the line through those of "
          "1000 and 100 000",
          {{"at_1000", first}, {"at_100000", last}, {"bytes_a_run", 1e6 * (last - first) / (many - few)}}});
}

}  // namespace

void add_memory() {
  benchmark::RegisterBenchmark("common_job_memory", common_job_memory)->UseManualTime()->Iterations(5);
  benchmark::RegisterBenchmark("sweep_memory", sweep_memory_growth)->UseManualTime()->Iterations(1);
}

}  // namespace loopwright::benchmarks
