// The program from outside: exit codes, output streams, and that an error leaves no files.
#include <gtest/gtest.h>
#include <filesystem>
#include <thread>
#include "tests/tools/command/program.h"

namespace loopwright::command_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* small =
    R"({"loopwright": 1, "title": "Small", "parameters": {"rate": 2}, "solver": {"stop": 1, "step": 0.125}, "blocks": {
  "c": {"type": "Constant", "value": "=rate"}, "x": {"type": "Integrator", "in": {"u": "c.y"}},
  "v": {"variants": {"gain": {"type": "Gain", "gain": 3}, "lag": {"type": "LowPass", "cutoff": 1}}, "variant": "gain", "in": {"u": "x.y"}}}, "log": ["x.y", "v.y"]})";
constexpr const char* wrong =
    R"({"loopwright": 1, "solver": {"stop": 1}, "blocks": {"g": {"type": "Gian", "gain": 1}, "h": {"type": "Gain", "gian": 1}}})";
constexpr const char* diverging = R"({"loopwright": 1, "solver": {"stop": 10, "step": 0.01}, "blocks": {
  "x": {"type": "Integrator", "initial": 1, "in": {"u": "p.product"}}, "p": {"type": "Product", "in": {"factors": ["x.y", "x.y"]}}}})";
constexpr const char* endless =
    R"({"loopwright": 1, "solver": {"stop": 100000, "step": 0.0001, "record_step": 1}, "blocks": {
  "t": {"type": "Clock"}, "x": {"type": "Integrator", "in": {"u": "t.time"}}}})";

class Command : public ::testing::Test {
 protected:
  void SetUp() override {
    if (access(program().c_str(), X_OK) != 0) GTEST_SKIP() << program() << " is not built";
    folder.with("small.json", small)
        .with("wrong.json", wrong)
        .with("diverging.json", diverging)
        .with("endless.json", endless);
  }
  Outcome run(std::vector<std::string> arguments) const {
    return loopwright_program(std::move(arguments), folder.path(""));
  }
  bool exists(const std::string& name) const { return fs::exists(folder.path(name)); }
  /// Files in the folder beside the four diagrams.
  size_t others() const { return size_t(std::distance(fs::directory_iterator(folder.path("")), {})) - 4; }
  DiagramFolder folder;
};

TEST_F(Command, ARunThatEndsWellAnswers0AndWritesItsRecording) {
  const Outcome outcome = run({"run", "small.json", "-o", "small.csv"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "done: 1 of 1 s")) << outcome.out;
  EXPECT_EQ(outcome.err, "") << "nothing was wrong";
  EXPECT_TRUE(contains(text_of(folder.path("small.csv")), "\n1,2,6\n")) << text_of(folder.path("small.csv"));
}

TEST_F(Command, ADashPutsTheDataOnStdout) {
  const Outcome outcome = run({"run", "small.json", "-o", "-", "--quiet"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_TRUE(outcome.out.starts_with("# loopwright recording")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "\n1,2,6\n")) << outcome.out;
  EXPECT_EQ(outcome.err, "") << "quiet";
}

TEST_F(Command, ADashNeverReplacesWhereStdoutLeads) {
  // Standard output is a file that has been unlinked: it gets the rows, and no new file appears.
  const std::string name = folder.path("lost");
  const int file = open(name.c_str(), O_CREAT | O_RDWR, 0600);
  ASSERT_GE(file, 0);
  fs::remove(name);
  const int saved = dup(STDOUT_FILENO);
  dup2(file, STDOUT_FILENO);
  const int status = std::system((program() + " run " + folder.path("small.json") + " -q -o -").c_str());
  dup2(saved, STDOUT_FILENO);
  close(saved);
  EXPECT_EQ(status, 0);
  EXPECT_GT(lseek(file, 0, SEEK_END), 200);
  close(file);
  EXPECT_EQ(others(), 0u);
}

TEST_F(Command, AWrongDiagramAnswers2AndWritesNothing) {
  const Outcome outcome = run({"run", "wrong.json", "-o", "wrong.csv", "--report", "wrong.html"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(contains(outcome.err, "wrong.json:1:") && contains(outcome.err, "did you mean \"Gain\"?") &&
              contains(outcome.err, "did you mean \"gain\"?"))
      << outcome.err;
  EXPECT_EQ(others(), 0u);
  EXPECT_EQ(outcome.out, "");
}

TEST_F(Command, AFailedRunAnswers1AndKeepsWhatWasComputed) {
  const Outcome outcome = run({"run", "diverging.json", "-o", "d.csv"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(contains(outcome.err, "diverged")) << outcome.err;
  const std::string csv = text_of(folder.path("d.csv"));
  EXPECT_TRUE(contains(csv, "incomplete")) << csv.substr(0, 300);
  EXPECT_TRUE(contains(csv, "\n0.5,")) << "rows before";
}

TEST_F(Command, AnInterruptedRunAnswers130AndKeepsWhatWasComputed) {
  for (int signal : {SIGINT, SIGTERM}) {
    Program endless_run(
        {"run", "endless.json", "-o", "e.csv", "--checkpoint", "c", "--checkpoint-every", "3"},
        folder.path(""));
    for (int i = 0; i < 600 && !exists("c"); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ASSERT_TRUE(exists("c")) << "it has not come to 3 s within half a minute";
    endless_run.send(signal);
    const Outcome outcome = endless_run.wait();
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "interrupted at t = ")) << outcome.err;
    const std::string csv = text_of(folder.path("e.csv"));
    EXPECT_TRUE(contains(csv, "incomplete") && contains(csv, "\n2,")) << csv.substr(0, 300);
    fs::remove(folder.path("e.csv"));
    fs::remove(folder.path("c"));
  }
}

TEST_F(Command, OutputsThatCannotBeWrittenAreRefusedBeforeTheRun) {
  for (const char* path : {"none/there.csv", ".", "run.txt", "run", ".csv/x"}) {
    const Outcome outcome = run({"run", "endless.json", "-o", path});
    EXPECT_EQ(outcome.code, 2) << path;
    EXPECT_TRUE(contains(outcome.err, path)) << outcome.err;
  }
  EXPECT_EQ(run({"run", "endless.json", "--report", "none/there.html"}).code, 2);
  EXPECT_EQ(others(), 0u);
}

TEST_F(Command, SettingsChangeTheRun) {
  const Outcome outcome =
      run({"run", "small.json", "--set", "rate=5", "--set", "solver.stop=2", "-o", "-", "-q"});
  EXPECT_TRUE(contains(outcome.out, "\n2,10,30\n")) << outcome.out << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "parameter rate: 5")) << "the recording says so";
}

TEST_F(Command, VariantsChangeTheRun) {
  EXPECT_TRUE(contains(run({"plan", "small.json", "--variant", "v=lag"}).out, "v (LowPass)"));
  EXPECT_TRUE(contains(run({"plan", "small.json"}).out, "v (Gain)"));
}

TEST_F(Command, MisspeltSettingsAndVariantsAnswer2WithWhatWasMeant) {
  const Outcome set = run({"run", "small.json", "--set", "rat=5"});
  EXPECT_EQ(set.code, 2);
  EXPECT_TRUE(contains(set.err, "did you mean \"rate\"?")) << set.err;
  const Outcome variant = run({"run", "small.json", "--variant", "v=gian"});
  EXPECT_EQ(variant.code, 2);
  EXPECT_TRUE(contains(variant.err, "did you mean \"gain\"?")) << variant.err;
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"run", "small.json", "--set", "rate"},
        {"run", "small.json", "--set", "=5"},
        {"run", "small.json", "--variant", "v"},
        {"run", "small.json", "--variant", "w=lag"},
        {"run", "small.json", "--checkpoint", "c"},
        {"run", "small.json", "--checkpoint-every", "1"},
        {"run", "small.json", "--resume", "none"},
        {"run", "small.json", "--run", "-1"},
        {"run", "none.json"},
        {"run"},
        {},
        {"rum"},
        {"run", "small.json", "--sett", "a=1"},
        {"plan"},
        {"check"},
        {"blocks", "Gian"},
        {"compare", "small.json"},
        {"compare", "small.json", "none.json"},
        {"schema", "extra"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << ::testing::PrintToString(arguments) << outcome.err;
    EXPECT_NE(outcome.err, "") << ::testing::PrintToString(arguments);
    EXPECT_EQ(outcome.out, "") << ::testing::PrintToString(arguments);
  }
  EXPECT_EQ(others(), 0u);
}

TEST_F(Command, CheckSaysAllThatIsWrongWithAllFiles) {
  const Outcome outcome = run({"check", "small.json", "wrong.json", "none.json"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(contains(outcome.out, "small.json: fine")) << outcome.out;
  EXPECT_TRUE(contains(outcome.err, "\"Gian\"") && contains(outcome.err, "\"gian\"") &&
              contains(outcome.err, "none.json"))
      << outcome.err;
  EXPECT_EQ(run({"check", "small.json", "endless.json"}).code, 0);
}

TEST_F(Command, PlanShowsTheScheduleOnStdout) {
  const Outcome outcome = run({"plan", "small.json"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
  for (const char* part : {"Small\n", "tick 1/8 s", "\norder\n", "once               c (Constant) y",
                           "\nstates\n  x (Integrator): 1 (y)"})
    EXPECT_TRUE(contains(outcome.out, part)) << part << outcome.out;
}

TEST_F(Command, BlocksListsAllAndDescribesOne) {
  const Outcome all = run({"blocks"}), one = run({"blocks", "Gain"}), near = run({"blocks", "Gian"});
  EXPECT_EQ(all.code + one.code, 0);
  EXPECT_TRUE(contains(all.out, "math\n") && contains(all.out, "  Gain ")) << all.out;
  EXPECT_TRUE(contains(one.out, "Multiplies a signal by a number") &&
              contains(one.out, "gain (number in $y/$u): Factor"))
      << one.out;
  EXPECT_TRUE(contains(near.err, "did you mean \"Gain\"?")) << near.err;
}

TEST_F(Command, HelpAndVersionAnswer0) {
  EXPECT_EQ(run({"--help"}).code, 0);
  EXPECT_EQ(run({"run", "--help"}).code, 0);
  const Outcome version = run({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_TRUE(version.out.starts_with("loopwright ")) << version.out;
}

TEST_F(Command, ACheckpointGoesOnInAnotherProcess) {
  ASSERT_EQ(
      run({"run", "small.json", "-q", "-o", "whole.csv", "--checkpoint", "c", "--checkpoint-every", "0.375"})
          .code,
      0);
  ASSERT_EQ(run({"run", "small.json", "-q", "-o", "rest.csv", "--resume", "c"}).code, 0);
  EXPECT_EQ(text_of(folder.path("whole.csv")), text_of(folder.path("rest.csv")));
  const Outcome other =
      run({"run", "small.json", "-q", "-o", "other.csv", "--resume", "c", "--set", "rate=3"});
  EXPECT_EQ(other.code, 2);
  EXPECT_TRUE(contains(other.err, "the diagram or its parameters (--set, --variant) have changed"))
      << other.err;
  EXPECT_FALSE(exists("other.csv"));
}

TEST_F(Command, AReportIsAWholePage) {
  ASSERT_EQ(run({"run", "small.json", "-q", "--report", "r.html"}).code, 0);
  const std::string page = text_of(folder.path("r.html"));
  EXPECT_TRUE(contains(page, "<title>") && contains(page, "</html>") && contains(page, "Small"));
}

TEST_F(Command, AMatFileIsWritten) {
  ASSERT_EQ(run({"run", "small.json", "-q", "-o", "r.mat"}).code, 0);
  EXPECT_TRUE(text_of(folder.path("r.mat")).starts_with("MATLAB 5.0 MAT-file"));
}

}  // namespace
}  // namespace loopwright::command_test
