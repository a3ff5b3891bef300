// A resumed run continues as if it had not been interrupted. A checkpoint of another run is rejected.
#include <gtest/gtest.h>
#include <fstream>
#include <sstream>
#include "tests/engine/written_diagram.h"

namespace loopwright::checkpoint_test {
namespace {

/// Every kind of memory: random stream, delay lines, discrete sums, states, modes, events.
std::string everything(std::string_view solver, std::string_view gain = "1") {
  return diagram(fmt::format(R"("n": {{"type": "Noise", "sample_time": 0.01, "standard_deviation": 1}},
    "sum": {{"type": "DiscreteIntegrator", "sample_time": 0.01, "in": {{"u": "n.y"}}}}, "d": {{"type": "Delay", "samples": 7, "sample_time": 0.01, "in": {{"u": "n.y"}}}},
    "g": {{"type": "Gain", "gain": {}, "in": {{"u": "d.y"}}}}, "x": {{"type": "LowPass", "cutoff": 20, "in": {{"u": "g.y"}}}}, "late": {{"type": "TransportDelay", "delay": 0.05, "in": {{"u": "x.y"}}}},
    "r": {{"type": "Relay", "switch_on": 0.05, "switch_off": -0.05, "in": {{"u": "late.y"}}}}, "y": {{"type": "Integrator", "in": {{"u": "r.y", "reset": "x.y"}}}})",
                             gain),
                 solver);
}

const char* const solvers[] = {R"("stop": 1, "step": 0.001, "record_step": 0.01)",
                               R"("stop": 1, "method": "dopri5", "record_step": 0.01)",
                               R"("stop": 1, "method": "cvode-bdf", "record_step": 0.01)",
                               R"("start": 0.355, "stop": 1, "step": 0.001, "record_step": 0.02)",
                               R"("start": 0.355, "stop": 1, "method": "dopri5", "record_step": 0.02)",
                               R"("stop": 1, "method": "heun", "step": 0.001, "record_step": 0.003)",
                               R"("stop": 1, "method": "dopri5", "record_step": 0.0003)"};

RunOptions write_every(double seconds, const std::string& file) {
  RunOptions options;
  options.checkpoint_file = file, options.checkpoint_every = seconds;
  return options;
}
RunOptions resume(const std::string& file) {
  RunOptions options;
  options.resume_file = file;
  return options;
}

TEST(Checkpoint, AResumedRunHasTheSameBitsAsOneThatWasNotStopped) {
  DiagramFolder folder;
  const std::string file = folder.path("run.checkpoint");
  for (const char* solver : solvers)
    for (const double every : {0.6, 0.37}) {
      const auto plan = plan_of(everything(solver));
      RunOptions options = write_every(every, file);
      const RunResult whole = simulate(*plan, options);
      ASSERT_EQ(whole.status, RunStatus::finished) << whole.message;
      options.resume_file = file;  // and writes checkpoints itself
      const RunResult rest = simulate(*plan, options);
      ASSERT_EQ(rest.recording.rows(), whole.recording.rows()) << solver;
      for (size_t c = 0; c < whole.recording.columns.size(); ++c)
        EXPECT_EQ(whole.recording.columns[c].values, rest.recording.columns[c].values)
            << solver << " " << whole.recording.columns[c].name;
    }
}

void expect_same(const RunResult& one, const RunResult& other, const std::string& what) {
  ASSERT_EQ(one.status, RunStatus::finished) << what << one.message;
  ASSERT_EQ(one.recording.rows(), other.recording.rows()) << what;
  for (size_t c = 0; c < one.recording.columns.size(); ++c)
    EXPECT_EQ(one.recording.columns[c].values, other.recording.columns[c].values)
        << what << " " << one.recording.columns[c].name;
}

/// Nothing sampled: only the solver's steps, or its events, advance the run.
const char* const smooth =
    R"("s": {"type": "Sine", "frequency": 1}, "x": {"type": "LowPass", "cutoff": 3, "in": {"u": "s.y"}}, "y": {"type": "LowPass", "cutoff": 30, "in": {"u": "x.y"}})";
const char* const eventful =
    R"("s": {"type": "Sine", "frequency": 1}, "x": {"type": "LowPass", "cutoff": 3, "in": {"u": "r.y"}}, "p": {"type": "PulseTrain", "period": 0.3, "width": 0.1},
    "sum": {"type": "Sum", "in": {"terms": ["x.y", "s.y", "p.y"]}}, "y": {"type": "Integrator", "in": {"u": "sum.sum", "reset": "s.y"}},
    "r": {"type": "Relay", "switch_on": 0.05, "switch_off": -0.05, "on": -1, "off": 1, "in": {"u": "y.y"}})";

TEST(Checkpoint, WritingOneChangesNoRun) {
  DiagramFolder folder;
  for (const char* solver : solvers)
    for (const double every : {0.3, 0.0937}) {
      const auto plan = plan_of(everything(solver));
      expect_same(simulate(*plan, write_every(every, folder.path("c"))), simulate(*plan), solver);
    }
  for (const char* blocks : {smooth, eventful})
    for (const char* method : {"dopri5", "cvode-bdf", "cvode-adams", "rk4"}) {
      const auto plan =
          plan_of(diagram(blocks, fmt::format(R"("stop": 5, "method": "{}", "record_step": 0.01)", method)));
      expect_same(simulate(*plan, write_every(0.37, folder.path("c"))), simulate(*plan), method);
    }
}

TEST(Checkpoint, BetweenSamplesHoldsTheWholeIntegrator) {
  DiagramFolder folder;
  for (const char* blocks : {smooth, eventful})
    for (const char* method : {"dopri5", "cvode-bdf", "cvode-adams", "rk4"})
      for (const double every : {4.1, 0.7}) {
        const std::string what = fmt::format("{} every {} s: {}", method, every, blocks);
        folder.with("c", "");
        const auto plan = plan_of(
            diagram(blocks, fmt::format(R"("stop": 5, "method": "{}", "record_step": 0.01)", method)));
        const RunResult whole = simulate(*plan, write_every(every, folder.path("c")));
        if (std::filesystem::file_size(folder.path("c")) == 0) {
          EXPECT_TRUE(std::string_view(method).starts_with("cvode") && blocks == smooth)
              << what << ": CVODE alone cannot be set aside inside its steps";
          continue;
        }
        const RunResult rest = simulate(*plan, resume(folder.path("c")));
        expect_same(rest, whole, what);
        EXPECT_EQ(rest.statistics.steps, whole.statistics.steps) << what;
        EXPECT_EQ(rest.statistics.events.size(), whole.statistics.events.size()) << what;
        for (size_t i = 0; i < rest.statistics.events.size(); ++i)
          EXPECT_EQ(rest.statistics.events[i].events, whole.statistics.events[i].events) << what;
      }
}

TEST(Checkpoint, StatisticsCountTheWholeRunHoweverOftenItWasSetAside) {
  DiagramFolder folder;
  const auto plan = plan_of(
      diagram(R"("s": {"type": "Sine", "frequency": 1}, "x": {"type": "Integrator", "in": {"u": "s.y"}})",
              R"("stop": 10, "method": "dopri5", "maximum_step": 0.1, "record_step": 1)"));
  EXPECT_GE(simulate(*plan, write_every(1, folder.path("c"))).statistics.steps, 100);
}

std::string refusal(const Plan& plan, const std::string& file) {
  try {
    simulate(plan, resume(file));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Checkpoint, OfOtherParametersOrAnotherDiagramIsRefused) {
  DiagramFolder folder;
  const std::string file = folder.path("c");
  simulate(*plan_of(everything(solvers[0])), write_every(0.6, file));
  EXPECT_EQ(refusal(*plan_of(everything(solvers[0])), file), "");
  EXPECT_TRUE(has(refusal(*plan_of(everything(solvers[0], "2")), file),
                  "the diagram or its parameters (--set, --variant) have changed"));
  EXPECT_TRUE(has(refusal(*plan_of(everything(solvers[1])), file), "belongs to something else"));
}

TEST(Checkpoint, OfARecordingThatHasChangedSinceIsRefusedByItsName) {
  DiagramFolder folder;
  const std::string file = folder.path("c");
  const auto load = [&](const char* rows) {
    folder.with("track.csv", std::string("time,x\n") + rows);
    folder.with("top.json", diagram(R"("t": {"type": "RecordedColumn", "file": "track.csv", "column": "x"},
      "x": {"type": "Integrator", "in": {"u": "t.value"}})"));
    return load_plan(folder.path("top.json"));
  };
  simulate(*load("0,1\n1,2\n"), write_every(0.5, file));
  EXPECT_EQ(refusal(*load("0,1\n1,2\n"), file), "");
  EXPECT_TRUE(has(refusal(*load("0,1\n1,3\n"), file), "the file \"track.csv\" has changed"));
}

TEST(Checkpoint, OfAnotherBuildIsRefused) {
  DiagramFolder folder;
  const std::string file = folder.path("c");
  const auto plan = plan_of(everything(solvers[0]));
  Plan other = *plan;
  other.identity.build = "0123456789abcdef", other.hash = other.identity.hash();
  simulate(other, write_every(0.6, file));
  EXPECT_TRUE(has(refusal(*plan, file), "the program is another build"));
}

TEST(Checkpoint, ThatIsDamagedShortOrMissingIsRefused) {
  DiagramFolder folder;
  const std::string file = folder.path("c");
  const auto plan =
      plan_of(diagram(R"("x": {"type": "Integrator", "in": {"u": "t.time"}}, "t": {"type": "Clock"})",
                      R"("stop": 1, "step": 0.1)"));
  simulate(*plan, write_every(0.5, file));
  std::ifstream in(file, std::ios::binary);
  std::stringstream stream;
  stream << in.rdbuf();
  const std::string good = stream.str();
  ASSERT_GT(good.size(), 100u);
  for (size_t i = 0; i < good.size(); i += 3) {
    std::string bad = good;
    bad[i] = char(bad[i] ^ 0x10);
    folder.with("bad", bad);
    EXPECT_NE(refusal(*plan, folder.path("bad")), "") << "byte " << i;
  }
  for (size_t length : {size_t(0), size_t(1), size_t(25), size_t(90), good.size() / 2, good.size() - 1})
    EXPECT_NE(refusal(*plan, folder.with("bad", good.substr(0, length)).path("bad")), "") << length;
  EXPECT_TRUE(has(refusal(*plan, folder.path("none")), "cannot be read"));
  EXPECT_EQ(refusal(*plan, folder.with("bad", good).path("bad")), "") << "the whole one is taken";
}

TEST(Checkpoint, ThatCannotBeWrittenIsAnErrorNotASilence) {
  const auto plan = plan_of(everything(solvers[0]));
  EXPECT_ANY_THROW(simulate(*plan, write_every(0.3, "/nonexistent/folder/c")));
}

}  // namespace
}  // namespace loopwright::checkpoint_test
