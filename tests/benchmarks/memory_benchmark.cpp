/// How much memory the program takes for one run.
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <stdexcept>
#include "tests/benchmarks/measure.h"

extern char** environ;

namespace loopwright::benchmarks {
namespace {

/// Peak resident memory of `program arguments…` in bytes; throws when it fails.
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

}  // namespace

void add_memory() {
  benchmark::RegisterBenchmark("common_job_memory", common_job_memory)->UseManualTime()->Iterations(5);
}

}  // namespace loopwright::benchmarks
