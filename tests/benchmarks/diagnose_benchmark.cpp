/// Duration of a diagnosis: a record of 56 s at 1 kHz, from the generator of the hidden-effect benchmark,
/// with two hidden effects.
#include <fmt/format.h>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include "tests/benchmarks/measure.h"
#include "tools/diagnose/diagnose.h"

namespace loopwright::benchmarks {
namespace {

void record_of_56_s(benchmark::State& state) {
  const std::string folder = std::filesystem::temp_directory_path() / "loopwright_diagnose_benchmark";
  const std::string generate =
      fmt::format("{} 1 {} many_speeds coulomb_friction cogging", LOOPWRIGHT_GENERATOR, folder);
  if (std::system(generate.c_str()) != 0) throw std::runtime_error("no record: " + generate);
  std::vector<double> seconds;
  Diagnosis diagnosis;
  for (auto _ : state) {
    seconds.push_back(seconds_of(
        [&] { diagnosis = diagnose(folder + "/nominal.json", {folder + "/train.experiment.json"}); }));
    state.SetIterationTime(seconds.back());
  }
  report(state, {"diagnose_56s_s",
                 median(seconds),
                 2,
                 "a record of 56 s at 1 kHz that hides Coulomb friction and cogging; CPU time on one core",
                 {{"effects_found", double(diagnosis.effects.size())}}});
}

}  // namespace

void add_diagnose() {
  benchmark::RegisterBenchmark("diagnose_56s", record_of_56_s)->UseManualTime()->Iterations(3);
}

}  // namespace loopwright::benchmarks
