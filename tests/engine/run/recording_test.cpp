// Results never depend on recording, saving or progress output: other rows, logs and checkpoints, the same
// bits.
#include <gtest/gtest.h>
#include <cstring>
#include "tests/engine/run/examples.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::recording_test {
namespace {

/// The value of a signal in the row at a time. Throws if there is no such row.
double at(const RunResult& result, std::string_view name, double time) {
  const auto& times = signal(result, "time");
  for (size_t row = 0; row < times.size(); ++row)
    if (times[row] == time) return signal(result, name)[row];
  throw std::invalid_argument(fmt::format("no row at {} s", time));
}

std::string relay_between_rows(std::string_view solver) {
  return diagram(R"("s": {"type": "PulseTrain", "period": 10, "width": 0.1, "start": 0.3},
    "r": {"type": "Relay", "switch_on": 0.5, "switch_off": -0.5, "in": {"u": "s.y"}})",
                 solver);
}

TEST(Recording, ASwitchBetweenRowsIsSeenWithoutAnyState) {
  for (const char* solver : {R"("stop": 2.25, "step": 0.001, "record_step": 0.25)",
                             R"("stop": 2.25, "method": "dopri5", "record_step": 0.25)",
                             R"("stop": 2.25, "method": "cvode-bdf", "record_step": 0.25)"}) {
    const RunResult result = run_of(relay_between_rows(solver));
    ASSERT_EQ(result.status, RunStatus::finished) << result.message;
    EXPECT_EQ(at(result, "r.y", 0.25), 0) << solver;
    EXPECT_EQ(at(result, "r.y", 0.5), 1) << solver;
    EXPECT_EQ(at(result, "r.y", 2.25), 1) << solver;
  }
  EXPECT_EQ(
      run_of(relay_between_rows(R"("stop": 2.25, "step": 0.001, "record_step": 0.25)")).statistics.steps,
      2250)
      << "steps are the solver's";
}

TEST(Recording, ADelayWithoutAnyStateHoldsItsSignal) {
  for (const char* solver : {R"("stop": 1, "step": 0.001, "record_step": 0.1)", R"("stop": 1, "step": 0.001)",
                             R"("stop": 1, "method": "dopri5", "record_step": 0.1)"}) {
    const RunResult result = run_of(diagram(R"("s": {"type": "Step", "time": 0.2501},
      "d": {"type": "TransportDelay", "delay": 0.25, "in": {"u": "s.y"}})",
                                            solver));
    for (size_t row = 0; row < result.recording.rows(); ++row)
      EXPECT_EQ(signal(result, "d.y")[row], signal(result, "time")[row] < 0.5001 ? 0 : 1)
          << solver << " t = " << signal(result, "time")[row];
  }
  const RunResult wave = run_of(diagram(R"("s": {"type": "Sine", "frequency": 2},
    "d": {"type": "TransportDelay", "delay": 0.25, "in": {"u": "s.y"}})",
                                        R"("stop": 1, "method": "dopri5", "record_step": 0.0625)"));
  for (size_t row = 5; row < 17; ++row)
    EXPECT_NEAR(signal(wave, "d.y")[row], signal(wave, "s.y")[row - 4], 1e-4) << row;
}

TEST(Recording, RowsInsideAFixedStepAreWhatAShorterStepGives) {
  // dx/dt = -x from 1, in steps of 0.1; rows every 0.03.
  const std::string blocks = R"("x": {"type": "Integrator", "initial": 1, "in": {"u": "g.y"}},
    "g": {"type": "Gain", "gain": -1, "in": {"u": "x.y"}})";
  const RunResult whole = run_of(diagram(blocks, R"("stop": 1, "step": 0.1)")),
                  inside = run_of(diagram(blocks, R"("stop": 1, "step": 0.1, "record_step": 0.03)"));
  const auto step = [](double h) { return 1 - h + h * h / 2 - h * h * h / 6 + h * h * h * h / 24; };
  for (size_t row = 0; row < inside.recording.rows(); ++row) {
    const double time = signal(inside, "time")[row], steps = std::floor(time / 0.1 + 1e-9);
    EXPECT_NEAR(signal(inside, "x.y")[row], std::pow(step(0.1), steps) * step(time - 0.1 * steps), 1e-14);
    EXPECT_EQ(signal(inside, "g.y")[row], -signal(inside, "x.y")[row]) << time;
  }
  for (const double time : {0.3, 0.6, 0.9, 1.0}) EXPECT_EQ(at(inside, "x.y", time), at(whole, "x.y", time));
}

/// Shipped diagrams that run by themselves, as files relative to diagrams/.
std::vector<std::string> shipped_diagrams() {
  std::vector<std::string> files = example_files();
  const std::filesystem::path root = LOOPWRIGHT_SOURCE "/diagrams";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    const auto& path = entry.path();
    if (path.extension() == ".json" && !path.stem().has_extension() &&
        path.parent_path().stem() != "examples")
      files.push_back(path.string());
  }
  return files;
}

/// The plan of a file with other rows and another stop, in multiples of its typical step. Null if it does not
/// run by itself, or cannot be changed in this way.
std::shared_ptr<const Plan> plan_with(const std::string& file, double record, double stop, bool few_signals) {
  LoadOptions options;
  options.set = {{"solver.record_step", fmt::format("{}", record)}, {"solver.stop", fmt::format("{}", stop)}};
  try {
    Problems problems;
    const auto loaded = load_diagram(file, options, problems);
    if (!loaded || problems.has_errors()) return nullptr;
    auto changed = *loaded;
    if (few_signals && changed.log.size() > 1) changed.log.resize(1);
    return compile(changed, problems);
  } catch (const InputError&) {
    return nullptr;
  }
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// Every row of one recording that has the time of a row of the other.
void expect_same_at_common_times(const RunResult& one, const RunResult& other, const std::string& what) {
  const auto &times = signal(one, "time"), &others = signal(other, "time");
  size_t row = 0, common = 0;
  for (size_t i = 0; i < times.size(); ++i) {
    while (row < others.size() && others[row] < times[i]) ++row;
    if (row == others.size() || others[row] != times[i]) continue;
    ++common;
    for (const Column& column : other.recording.columns) {
      const double here = signal(one, column.name)[i];
      ASSERT_TRUE(same_bits(here, column.values[row]))
          << what << " " << column.name << " at " << times[i] << " s: " << here << ", " << column.values[row];
    }
  }
  EXPECT_GE(common, 3u) << what;
}

TEST(Recording, OfShippedDiagramsChangesNoNumber) {
  int tried = 0, variable = 0;
  DiagramFolder folder;
  for (const std::string& file : shipped_diagrams()) {
    LoadOptions options;
    Problems problems;
    const auto loaded = load_diagram(file, options, problems);
    if (!loaded || problems.has_errors() || !loaded->solver.stop.is_given) continue;
    const auto plan = compile(*loaded, problems);
    if (!plan || plan->blocks.empty()) continue;
    const double start = plan->clock.time(plan->start_tick), step = plan->typical_step,
                 stop = start + std::min(60 * step, plan->clock.time(plan->stop_tick) - start);
    if (!(stop > start)) continue;
    const auto usual = plan_with(file, 3 * step, stop, false);
    if (!usual) continue;
    const RunResult reference = simulate(*usual);
    if (reference.status != RunStatus::finished) continue;
    ++tried, variable += !is_fixed_step(plan->method);
    for (const double factor : {0.5, 1.0, 1.5, 12.0}) {
      const auto other = plan_with(file, factor * step, stop, factor != 1.0);
      ASSERT_TRUE(other) << file;
      RunOptions saving;
      if (factor == 12.0)  // each is written to disk before the run continues: a few are sufficient
        saving.checkpoint_file = folder.path("c"), saving.checkpoint_every = 23.3 * step;
      saving.progress = [](double, double) {};
      const RunResult result = simulate(*other, saving);
      ASSERT_EQ(result.status, RunStatus::finished) << file << ": " << result.message;
      expect_same_at_common_times(reference, result, fmt::format("{} rows every {} steps", file, factor));
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(tried, 90);
  EXPECT_GT(variable, 3);
}

TEST(Recording, OfALoopThatNewtonSolvesChangesNoNumber) {
  // Newton's method starts at its last solution, which a row of the recording must not change.
  const std::string blocks =
      R"json("t": {"type": "Clock"}, "f": {"type": "Expression", "formula": "cos(y)+t", "names": ["y", "t"], "in": {"arguments": ["f.y", "t.time"]}},
    "x": {"type": "Integrator", "in": {"u": "f.y"}},
    "only_seen": {"type": "Expression", "formula": "sin(y)/2+t", "names": ["y", "t"], "in": {"arguments": ["only_seen.y", "t.time"]}})json";
  for (const char* method : {R"("step": 0.01)", R"("method": "dopri5")", R"("method": "cvode-bdf")"}) {
    const auto run = [&](double record) {
      return run_of(diagram(
          blocks,
          fmt::format(R"("stop": 2, "record_step": {}, "algebraic_loops": "solve", {})", record, method)));
    };
    const RunResult reference = run(0.05);
    ASSERT_EQ(reference.status, RunStatus::finished) << reference.message;
    for (const double record : {0.003, 0.01, 0.1, 0.4})
      expect_same_at_common_times(reference, run(record), fmt::format("{} {}", method, record));
  }
}

TEST(Recording, TheWindowOfChatteringIsTheSolversNotTheRecordings) {
  for (const double record : {1e-5, 0.01, 1.0}) {
    const RunResult result = run_of(diagram(
        R"("x": {"type": "Integrator", "initial": 0.1, "in": {"u": "push.y"}}, "sign": {"type": "Sign", "in": {"u": "x.y"}},
      "push": {"type": "Gain", "gain": -1, "in": {"u": "sign.y"}})",
        fmt::format(R"("stop": 1, "method": "dopri5", "record_step": {})", record)));
    EXPECT_EQ(result.status, RunStatus::failed);
    EXPECT_EQ(
        result.message,
        run_of(
            diagram(
                R"("x": {"type": "Integrator", "initial": 0.1, "in": {"u": "push.y"}}, "sign": {"type": "Sign", "in": {"u": "x.y"}},
      "push": {"type": "Gain", "gain": -1, "in": {"u": "sign.y"}})",
                R"("stop": 1, "method": "dopri5")"))
            .message)
        << record;
  }
}

}  // namespace
}  // namespace loopwright::recording_test
