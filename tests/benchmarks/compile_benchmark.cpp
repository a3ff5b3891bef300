/// The time from a file to a plan, and whether the cost of a block is independent of the size of the diagram.
#include <fmt/format.h>
#include "engine/plan/plan.h"
#include "tests/benchmarks/diagram_file.h"
#include "tests/benchmarks/measure.h"

namespace loopwright::benchmarks {
namespace {

constexpr int blocks_of_axis = 10;

/// Motor axes, each following the previous one: controllers, friction, forces, with units on the wires.
std::string diagram_of(int blocks) {
  std::string text = R"({
  "loopwright": 1,
  "parameters": {"mass": {"value": 0.25, "unit": "kg"}},
  "solver": {"method": "rk4", "step": 0.0001, "stop": 1},
  "blocks": {
    "lead": {"type": "Sine", "amplitude": {"value": 0.1, "unit": "m"}, "frequency": 1})";
  const auto add = [&](int axis, std::string_view name, std::string_view entry) {
    text += fmt::format(",\n    \"{}_{}\": {{{}}}", name, axis, entry);
  };
  for (int i = 0; i < blocks / blocks_of_axis; ++i) {
    const std::string before = i == 0 ? "lead.y" : fmt::format("filter_{}.y", i - 1);
    add(i, "encoder",
        fmt::format(
            R"("type": "Encoder", "sample_time": 0.001, "resolution": 1e-7, "in": {{"position": "stage_{}.position"}})",
            i));
    add(i, "feedback",
        fmt::format(
            R"("type": "PdController", "sample_time": 0.001, "Kp": 2000, "Kd": 30, "derivative_pole": 1000, "in": {{"reference": "{}", "measured": "encoder_{}.position"}})",
            before, i));
    add(i, "gain",
        fmt::format(R"("type": "Gain", "gain": "=2*mass", "in": {{"u": "feedback_{}.command"}})", i));
    add(i, "limit",
        fmt::format(R"("type": "Saturation", "low": -100, "high": 100, "in": {{"u": "gain_{}.y"}})", i));
    add(i, "viscous",
        fmt::format(
            R"("type": "ViscousFriction", "damping": {{"value": 3, "unit": "N*s/m"}}, "in": {{"velocity": "stage_{}.velocity"}})",
            i));
    add(i, "cogging",
        fmt::format(
            R"("type": "CoggingForce", "pole_pitch": {{"value": 22.5, "unit": "mm"}}, "harmonics": [{{"amplitude": 2}}, {{"order": 2, "amplitude": 0.5}}], "in": {{"position": "stage_{}.position"}})",
            i));
    add(i, "coulomb",
        fmt::format(
            R"("type": "SmoothCoulombFriction", "level": 0.3, "transition_speed": 0.05, "in": {{"velocity": "stage_{}.velocity"}})",
            i));
    add(i, "force",
        fmt::format(
            R"("type": "Sum", "signs": "+---", "in": {{"terms": ["limit_{0}.y", "viscous_{0}.force", "cogging_{0}.force", "coulomb_{0}.force"]}})",
            i));
    add(i, "stage", fmt::format(R"("type": "Mass", "mass": "=mass", "in": {{"force": "force_{}.sum"}})", i));
    add(i, "filter",
        fmt::format(
            R"("type": "LowPass", "cutoff": {{"value": 30, "unit": "Hz"}}, "in": {{"u": "stage_{}.position"}})",
            i));
  }
  return text + "\n  },\n  \"log\": [\"stage_0.position\"]\n}\n";
}

void compile_1000_blocks(benchmark::State& state) {
  const DiagramFile file(diagram_of(1000));
  std::vector<double> seconds;
  for (auto _ : state) {
    seconds.push_back(seconds_of([&] { benchmark::DoNotOptimize(load_plan(file.path())); }));
    state.SetIterationTime(seconds.back());
  }
  report(state, {"compile_1000_blocks_s",
                 median(seconds),
                 0.1,
                 "load_plan of a file with 1000 blocks of ten types; CPU time, median",
                 {{"repetitions", double(seconds.size())}}});
}

void compile_100000_blocks(benchmark::State& state) {
  const DiagramFile small(diagram_of(1000)), large(diagram_of(100000));
  constexpr int repeats = 20;
  const Pairs pairs = alternate(
      state, [&] { benchmark::DoNotOptimize(load_plan(large.path())); },
      [&] {
        for (int i = 0; i < repeats; ++i) benchmark::DoNotOptimize(load_plan(small.path()));
      });
  report(state, {"compile_cost_ratio_100000_to_1000",
                 median(pairs.ratio) * repeats / 100.0,
                 0,
                 "CPU time a block of load_plan with 100,000 blocks over that with 1000, in turn, median of "
                 "pairwise ratios; 1: linear",
                 {{"seconds_100000", median(pairs.first)},
                  {"seconds_1000", median(pairs.second) / repeats},
                  {"pairs", double(pairs.ratio.size())}}});
}

}  // namespace

void add_compile() {
  benchmark::RegisterBenchmark("compile_1000_blocks", compile_1000_blocks)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond)
      ->Iterations(21);
  benchmark::RegisterBenchmark("compile_100000_blocks", compile_100000_blocks)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond)
      ->Iterations(5);
}

}  // namespace loopwright::benchmarks
