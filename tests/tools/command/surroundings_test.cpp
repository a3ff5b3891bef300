// Inputs and outputs of the program: inputs that are not files, outputs that cannot be written, readers that
// ended.
#include <gtest/gtest.h>
#include <chrono>
#include <filesystem>
#include <regex>
#include <sys/stat.h>
#include <thread>
#include "tests/tools/command/program.h"

namespace loopwright::surroundings_test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* small = R"({"loopwright": 1, "solver": {"stop": 1, "step": 0.125}, "blocks": {
  "c": {"type": "Constant", "value": 2}, "x": {"type": "Integrator", "in": {"u": "c.y"}}}})";

class Surroundings : public ::testing::Test {
 protected:
  void SetUp() override {
    if (access(program().c_str(), X_OK) != 0) GTEST_SKIP() << program() << " is not built";
    folder.with("small.json", small);
  }
  /// Exit code of a shell command in the folder; $P is the program.
  int shell(const std::string& command) const {
    const std::string all =
        "cd " + folder.path("") + " && export P=" + program() + " && timeout 60 bash -c '" + command + "'";
    const int status = std::system(all.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  std::string text(const std::string& name) const { return text_of(folder.path(name)); }
  DiagramFolder folder;
};

TEST_F(Surroundings, AnAnswerThatCannotBeWrittenIsAFailure) {
  for (const char* command : {"plan small.json", "blocks", "blocks Gain", "schema", "run small.json -q -o -",
                              "run small.json --json - -q", "linearize small.json --json -", "--help"}) {
    if (shell(std::string("$P ") + command + " >out 2>err") != 0) continue;  // no such option
    EXPECT_EQ(shell(std::string("$P ") + command + " >/dev/full 2>err"), 1) << command;
    EXPECT_NE(text("err").find("No space left on device"), std::string::npos) << command << text("err");
  }
}

TEST_F(Surroundings, AResultForAStandardOutputThatIsClosedIsAFailure) {
  folder.with("data.csv", "t,u\n0,2\n1,2\n")
      .with("e.json", R"({"loopwright": 1, "data": "data.csv", "time": "t",
    "compare": {"c.y": {"column": "u", "unit": "1"}}})")
      .with("sweep.json", R"({"loopwright": 1, "diagram": "small.json",
    "axes": {"c.value": {"values": [1, 2]}}, "metrics": {"a": {"final": "x.y"}}})");
  for (const char* command :
       {"schema", "blocks", "blocks --markdown", "--help", "--version", "check small.json", "plan small.json",
        "run small.json", "run small.json -q -o -", "linearize small.json", "linearize small.json --json -",
        "compare small.json e.json", "compare small.json e.json --json -",
        "sweep sweep.json --minimize a --evaluations 2"}) {
    ASSERT_EQ(shell(std::string("$P ") + command + " >out 2>err"), 0) << command << text("err");
    EXPECT_EQ(shell(std::string("$P ") + command + " >&- 2>err"), 1) << command;
    EXPECT_NE(text("err").find("the standard output is closed"), std::string::npos) << command << text("err");
  }
}

TEST_F(Surroundings, AClosedStandardOutputHasNoOtherName) {
  for (const char* name : {"/dev/stdout", "/proc/self/fd/1"}) {
    const std::string command = std::string("$P linearize small.json --json ") + name;
    EXPECT_EQ(shell(command + " >out 2>err"), 0) << name << text("err");
    EXPECT_NE(shell(command + " >&- 2>err"), 0) << name;
  }
}

TEST_F(Surroundings, ASummaryOfResultsInFilesMayBeLost) {
  folder.with("sweep.json", R"({"loopwright": 1, "diagram": "small.json",
    "axes": {"c.value": {"values": [1, 2]}}, "metrics": {"a": {"final": "x.y"}}})");
  for (const char* command :
       {"run small.json -o o.csv", "run small.json --report o.html", "linearize small.json --json o.json",
        "sweep sweep.json -o results", "sweep merge results", "sweep report results"})
    EXPECT_EQ(shell(std::string("$P ") + command + " >&- 2>err"), 0) << command << text("err");
  EXPECT_TRUE(text("o.csv").ends_with("\n1,2,2\n"));
  EXPECT_NE(text("results/results.csv"), "");
}

TEST_F(Surroundings, AReaderThatGoesAwayEndsTheProgramWithoutASignal) {
  EXPECT_EQ(shell("set -o pipefail; $P schema 2>err | head -c 1 >out; exit ${PIPESTATUS[0]}"), 1);
  EXPECT_EQ(text("err"), "") << "it has what it wanted";
  EXPECT_EQ(shell("$P schema >out 2> >(exit 0)"), 0);
}

TEST_F(Surroundings, NobodyNeedsToListen) {
  for (const char* nobody : {"2>/dev/full", "2>&-", ">&- 2>&-", "<&- >&- 2>&-", "2> >(exit 0)"}) {
    fs::remove(folder.path("o.csv"));
    EXPECT_EQ(shell(std::string("$P run small.json -o o.csv ") + nobody), 0) << nobody;
    EXPECT_TRUE(text("o.csv").ends_with("\n1,2,2\n")) << nobody << text("o.csv");
    EXPECT_EQ(shell(std::string("$P check nothing.json ") + nobody), 2) << nobody;
  }
}

TEST_F(Surroundings, WhatIsNoFileIsRefusedAtOnce) {
  ASSERT_EQ(mkfifo(folder.path("fifo.json").c_str(), 0600), 0);
  ASSERT_EQ(mkfifo(folder.path("fifo.csv").c_str(), 0600), 0);
  ASSERT_EQ(mkfifo(folder.path("fifo.so").c_str(), 0600), 0);
  folder
      .with("sub.json",
            R"({"loopwright": 1, "solver": {"stop": 1}, "blocks": {"a": {"diagram": "fifo.json"}}})")
      .with("csv.json", R"({"loopwright": 1, "solver": {"stop": 1}, "blocks": {
          "a": {"type": "RecordedColumn", "file": "fifo.csv", "column": "x"}}})")
      .with("model.json", R"({"loopwright": 1, "solver": {"stop": 1}, "blocks": {
          "c": {"type": "Constant", "value": 0},
          "a": {"type": "Gpr", "model": "fifo.json", "in": {"position": "c.y", "velocity": "c.y"}}}})");
  for (const char* command :
       {"check fifo.json", "check sub.json", "check csv.json", "check model.json", "run /dev/zero", "check .",
        "sweep fifo.json -o results", "gp show fifo.json", "gp train fifo.json --model m",
        "compare small.json fifo.json", "run small.json --resume fifo.json",
        "check small.json --blocks fifo.so", "run small.json --blocks /dev/zero"}) {
    const auto begin = Clock::now();
    EXPECT_EQ(shell(std::string("$P ") + command + " 2>err"), 2) << command;
    EXPECT_LT(Clock::now() - begin, std::chrono::seconds(30)) << command;
    EXPECT_TRUE(std::regex_search(text("err"), std::regex("it is a (pipe|device|folder)")))
        << command << text("err");
  }
}

TEST_F(Surroundings, TextOfAFileCannotSteerTheTerminal) {
  folder.with("evil.json",
              "{\"loopwright\": 1, \"title\": \"\\u001b[2Jgone\", \"solver\": {\"stop\": 1}, "
              "\"blocks\": {\"a\": {\"type\": \"\\u001b[31mGian\"}}}");
  folder.with("named.json",
              "{\"loopwright\": 1, \"solver\": {\"stop\": 1}, \"blocks\": {\"a\\u001b]0;t\\u0007\": "
              "{\"type\": \"Clock\"}}}");
  folder.with("titled.json",
              "{\"loopwright\": 1, \"title\": \"\\u001b[2Jgone\", \"solver\": {\"stop\": 1}, "
              "\"blocks\": {\"a\": {\"type\": \"Constant\", \"value\": 1}}}");
  for (const char* command : {"check evil.json", "check named.json", "plan titled.json", "run titled.json"}) {
    shell(std::string("$P ") + command + " >out 2>err");
    EXPECT_EQ((text("out") + text("err")).find_first_of("\x1b\x07"), std::string::npos)
        << text("out") << text("err");
  }
  shell("$P check evil.json 2>err");
  EXPECT_NE(text("err").find("\\x1b[31mGian"), std::string::npos) << text("err");
}

TEST_F(Surroundings, ASmallStackIsEnough) {
  std::string nested =
      R"("c": {"type": "Constant", "value": "=)" + std::string(60, '(') + "1" + std::string(60, ')') + "\"}";
  folder.with("nested.json", R"({"loopwright": 1, "solver": {"stop": 1}, "blocks": {)" + nested + "}}");
  for (const char* command :
       {"check nested.json", "run small.json -o - -q", "linearize small.json", "blocks"})
    EXPECT_EQ(shell(std::string("ulimit -s 256; $P ") + command + " >out 2>err"), 0)
        << command << text("err");
}

TEST_F(Surroundings, AnInterruptionIsObeyedInTheMiddleOfALongRunOfASweep) {
  folder.with("long.json",
              R"({"loopwright": 1, "solver": {"stop": 100000, "step": 0.0001, "record_step": 1}, "blocks": {
    "t": {"type": "Clock"}, "x": {"type": "Integrator", "initial": 1, "in": {"u": "t.time"}}}})");
  folder.with("sweep.json",
              R"({"loopwright": 1, "diagram": "long.json", "axes": {"x.initial": {"values": [1, 2]}},
    "metrics": {"a": {"final": "x.y"}}})");
  Program sweep({"sweep", "sweep.json", "-o", "results", "-j", "1"}, folder.path(""));
  for (int i = 0; i < 600 && !fs::exists(folder.path("results/sweep_file.txt")); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  ASSERT_TRUE(fs::exists(folder.path("results/sweep_file.txt")));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const auto begin = Clock::now();
  sweep.send(SIGTERM);
  const Outcome outcome = sweep.wait();
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_LT(Clock::now() - begin, std::chrono::milliseconds(1000));
}

TEST_F(Surroundings, TablesOfAnIncompleteSweepAreAFailure) {
  folder.with("sweep.json", R"({"loopwright": 1, "diagram": "small.json",
    "axes": {"c.value": {"linear": {"from": 1, "to": 2, "count": 100}}}, "metrics": {"a": {"final": "x.y"}}})");
  ASSERT_EQ(shell("$P sweep sweep.json -o results --shard 0/2 2>err"), 0) << text("err");
  EXPECT_EQ(shell("$P sweep merge results >out 2>err"), 1);
  EXPECT_NE(text("out").find("36 are missing"), std::string::npos) << text("out");
  ASSERT_EQ(shell("$P sweep sweep.json -o results --shard 1/2 2>err"), 0) << text("err");
  EXPECT_EQ(shell("$P sweep merge results 2>err"), 0) << text("err");
}

TEST_F(Surroundings, WhatAKilledSweepLeftHalfWrittenIsTakenAway) {
  folder.with("sweep.json", R"({"loopwright": 1, "diagram": "small.json",
    "axes": {"c.value": {"values": [1, 2, 3]}}, "metrics": {"a": {"final": "x.y"}}})");
  ASSERT_EQ(shell("$P sweep sweep.json -o results 2>err"), 0) << text("err");
  ASSERT_EQ(shell("bash -c \"exit 0\" & wait; "
                  "for f in results.csv results.mat sweep_file.txt; do echo half > results/.$f.$!-3; done"),
            0);
  EXPECT_EQ(shell("ls -A results | grep -c ^[.]"), 0) << "there are some";
  ASSERT_EQ(shell("$P sweep sweep.json -o results --resume 2>err"), 0) << text("err");
  EXPECT_EQ(shell("ls -A results | grep -c ^[.]"), 1) << "there are none";
}

}  // namespace
}  // namespace loopwright::surroundings_test
