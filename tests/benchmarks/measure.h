/// Reliable times on a busy machine: CPU time, both sides alternately in one process, medians.
#pragma once
#include <benchmark/benchmark.h>
#include <string>
#include <utility>
#include <vector>

namespace loopwright::benchmarks {

/// [s] used by this thread.
double cpu_time();

template <class F> double seconds_of(F&& f) {
  const double start = cpu_time();
  f();
  return cpu_time() - start;
}

double median(std::vector<double> values);

/// A B A B …: the ratio of every pair, so that a temporary slowdown of the machine affects both sides.
struct Pairs {
  std::vector<double> first, second, ratio;
  void add(double a, double b) { first.push_back(a), second.push_back(b), ratio.push_back(a / b); }
};
/// Measures one pair for each iteration. The benchmark's own time is that of the first side.
template <class First, class Second>
Pairs alternate(benchmark::State& state, First&& first, Second&& second) {
  Pairs pairs;
  first(), second();  // warms up caches, branch predictors and clock frequency
  for (auto _ : state) {
    const double a = seconds_of(first);
    pairs.add(a, seconds_of(second));
    state.SetIterationTime(a);
  }
  return pairs;
}

/// One figure of merit with the bar that it must not exceed, or must reach.
struct Figure {
  std::string key;
  double value = 0;
  double bar = 0;        ///< 0: reported only
  std::string measured;  ///< what is measured and how, in a sentence
  std::vector<std::pair<std::string, double>> details;
  double at_least = 0;  ///< 0: no such bar
};
/// Adds it to the report and to the benchmark's line on the terminal.
void report(benchmark::State& state, Figure figure);

// The benchmarks of each file, to be added in this order: the memory of a child process includes that of its
// parent, so memory is measured while this process is small.
void add_memory();
void add_common_job();
void add_compile();
void add_gp();
void add_sweep();
void add_deploy();
void add_diagnose();

/// The report as JSON: the machine, then every figure under its key.
std::string report_text();
/// Keys of the figures that miss their bar.
std::vector<std::string> missed_bars();

}  // namespace loopwright::benchmarks
