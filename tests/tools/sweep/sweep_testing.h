/// Shared parts of tests of sweeps: a small loop, sweeps over it, temporary folders.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <bit>
#include <filesystem>
#include <string>
#include "tests/engine/diagram/diagram_folder.h"
#include "tools/sweep/run_sweep.h"

namespace loopwright {

/// A mass on a spring, driven by a sine: two states, accurate with few steps. Its damping depends on an
/// expression, its noise on the number of the run.
inline const char* const small_loop = R"json({
  "loopwright": 1, "solver": {"method": "rk4", "step": 0.01, "stop": 0.5},
  "parameters": {"damping_ratio": 0.3, "stiffness": 40},
  "blocks": {
    "pull":   {"type": "Sine", "amplitude": 1, "frequency": 12},
    "noise":  {"type": "Noise", "sample_time": 0.05, "standard_deviation": 0.1},
    "spring": {"type": "Gain", "gain": "=stiffness", "in": {"u": "mass.position"}},
    "damper": {"type": "Gain", "gain": "=2*damping_ratio*sqrt(stiffness)", "in": {"u": "mass.velocity"}},
    "force":  {"type": "Sum", "signs": "++--", "in": {"terms": ["pull.y", "noise.y", "spring.y", "damper.y"]}},
    "mass":   {"type": "Mass", "mass": 1, "in": {"force": "force.sum"}}
  },
  "log": ["mass.position", "mass.velocity"]})json";

inline const char* const metrics_of_all_kinds = R"(
  "a": {"rms": "mass.position"}, "b": {"mean": "mass.position"}, "c": {"maximum": "mass.position"},
  "d": {"minimum": "mass.velocity"}, "e": {"peak": "=mass.position - 0.5*mass.velocity", "from": 0.1, "to": 0.4},
  "f": {"final": "mass.position"}, "g": {"settling_time": "mass.position", "target": 0, "band": 0.01},
  "h": {"overshoot": "mass.position", "target": 0.01}, "i": {"percentile": "mass.velocity", "percent": 90},
  "j": {"first_violation": "mass.velocity", "threshold": 0.05})";

/// A folder with loop.json and sweep.json.
struct SweepFolder {
  DiagramFolder folder;
  explicit SweepFolder(const std::string& axes, const std::string& more = "",
                       const std::string& metrics = metrics_of_all_kinds,
                       const std::string& loop = small_loop) {
    folder.with("loop.json", loop);
    folder.with(
        "sweep.json",
        fmt::format(R"({{"loopwright": 1, "diagram": "loop.json", "axes": {{{}}}, "metrics": {{{}}}{}}})",
                    axes, metrics, more));
  }
  std::string results(const std::string& name = "results") const { return folder.path(name); }
  SweepPlan plan() const {
    Problems problems;
    auto sweep = load_sweep(folder.path("sweep.json"), problems);
    if (!sweep) throw InputError(std::move(problems));
    return SweepPlan(std::move(sweep));
  }
  std::string problems() const {
    try {
      plan();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

/// Every number of a table, bit for bit.
inline std::vector<uint64_t> bits_of(const Recording& table) {
  std::vector<uint64_t> bits;
  for (const Column& column : table.columns)
    for (const double value : column.values) bits.push_back(std::bit_cast<uint64_t>(value));
  return bits;
}

inline const char* const four_axis_values = R"(
  "mass.mass": {"linear": {"from": 0.5, "to": 2, "count": 4}, "unit": "kg"},
  "stiffness": {"uniform": {"from": 20, "to": 80}},
  "pull.frequency": {"normal": {"mean": 12, "deviation": 2}})";
inline const char* const forty_samples = R"(, "samples": {"method": "latin_hypercube", "count": 40})";

/// Runs the missing runs in the folder `name`. Returns every number of its table.
inline std::vector<uint64_t> bits_with(const SweepPlan& plan, const SweepFolder& folder,
                                       const std::string& name, SweepOptions options) {
  const std::string results = folder.results(name);
  options.resume = std::filesystem::exists(results);
  run_sweep(plan, results, options);
  const SweepResults read = read_results(plan, results);
  EXPECT_EQ(read.missing, 0);
  return bits_of(read.table);
}

}  // namespace loopwright
