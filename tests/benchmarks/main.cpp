/// benchmarks REPORT.json [Google Benchmark's options]: measures, writes the report, exit code 1 if a bar is
/// missed.
#include <fmt/format.h>
#include "engine/record/atomic_file.h"
#include "tests/benchmarks/measure.h"

int main(int argc, char** argv) {
  using namespace loopwright;
  benchmark::Initialize(&argc, argv);
  if (argc != 2) {
    fmt::print(stderr, "usage: {} REPORT.json [--benchmark_filter=…]\n", argv[0]);
    return 2;
  }
  benchmarks::add_memory();
  benchmarks::add_common_job();
  benchmarks::add_compile();
  benchmarks::add_gp();
  benchmarks::add_sweep();
  benchmarks::add_deploy();
  benchmarks::add_diagnose();
  try {
    if (benchmark::RunSpecifiedBenchmarks() == 0) return 2;
    write_file(argv[1], benchmarks::report_text());
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
  const auto missed = benchmarks::missed_bars();
  for (const std::string& key : missed) fmt::print(stderr, "beyond its bar: {}\n", key);
  return missed.empty() ? 0 : 1;
}
