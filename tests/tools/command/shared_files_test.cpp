// An output that is a file which the command reads: refused before anything runs, and the file stays as it
// was.
#include <gtest/gtest.h>
#include <filesystem>
#include "tests/tools/command/program.h"

namespace loopwright::shared_files_test {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

class SharedFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder.with("data.csv", "t,u\n0,1\n1,2\n2,3\n")
        .with("inner.json", R"({"loopwright": 1, "inputs": {"u": ""}, "outputs": {"y": {"source": "g.y"}},
    "blocks": {"g": {"type": "Gain", "gain": 2, "in": {"u": "u"}}}})")
        .with("top.json",
              R"({"loopwright": 1, "solver": {"method": "rk4", "stop": 1, "step": 0.125}, "blocks": {
    "r": {"type": "RecordedColumn", "file": "data.csv", "column": "u", "interpolation": "linear"},
    "s": {"diagram": "inner.json", "in": {"u": "r.value"}},
    "x": {"type": "Integrator", "in": {"u": "s.y"}}}})")
        .with("e.json", R"({"loopwright": 1, "data": "measured.csv", "time": "t",
    "compare": {"x.y": {"column": "x", "unit": "1"}}})")
        .with("measured.csv", "t,x\n0,0\n0.5,1\n1,2\n")
        .with("t.json", R"({"loopwright": 1, "recordings": ["measured.csv"], "position": {"column": "x"},
    "velocity": {"column": "x"}, "label": {"columns": ["x"]}, "velocities": [0.1], "kernel": "product",
    "period": {"value": 1, "unit": "m"}})")
        .with("s.json", R"({"loopwright": 1, "diagram": "of_results.json",
    "axes": {"x.initial": {"values": [1, 2]}}, "metrics": {"a": {"final": "x.y"}}})")
        .with("of_results.json", R"({"loopwright": 1, "solver": {"stop": 1, "step": 0.125}, "blocks": {
    "r": {"type": "RecordedColumn", "file": "tables/results.csv", "column": "u"},
    "x": {"type": "Integrator", "in": {"u": "r.value"}}}})")
        .with("tables/results.csv", "t,u\n0,1\n1,2\n");
    fs::create_hard_link(folder.path("data.csv"), folder.path("link.csv"));
    fs::create_symlink("data.csv", folder.path("symbolic.csv"));
  }
  Outcome run(Arguments arguments) const { return loopwright_program(std::move(arguments), folder.path("")); }
  /// Every file of the folder with its contents.
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder.path("")))
      if (entry.is_regular_file()) all[entry.path().string()] = text_of(entry.path().string());
    return all;
  }
  DiagramFolder folder;
};

TEST_F(SharedFiles, AFileThatAnInputNamesIsNoOutput) {
  struct Case {
    Arguments arguments;
    std::string option, file;  // both are in the message
  };
  const auto before = contents();
  for (const Case& c : std::vector<Case>{
           {{"run", "top.json", "-o", "data.csv"}, "--output", "data.csv"},
           {{"run", "top.json", "-o", "link.csv"}, "--output", "data.csv"},
           {{"run", "top.json", "-o", "symbolic.csv"}, "--output", "data.csv"},
           {{"run", "top.json", "--report", "inner.json"}, "--report", "inner.json"},
           {{"run", "top.json", "--checkpoint", "data.csv", "--checkpoint-every", "1"},
            "--checkpoint",
            "data.csv"},
           {{"plan", "top.json", "--svg", "data.csv"}, "--svg", "data.csv"},
           {{"linearize", "top.json", "--json", "data.csv"}, "--json", "data.csv"},
           {{"stability", "top.json", "--json", "data.csv"}, "--json", "data.csv"},
           {{"compare", "top.json", "e.json", "--report", "measured.csv"}, "--report", "measured.csv"},
           {{"compare", "top.json", "e.json", "--json", "data.csv"}, "--json", "data.csv"},
           {{"fit", "top.json", "e.json", "--parameters", "x.initial", "-o", "inner.json"},
            "--output",
            "inner.json"},
           {{"fit", "top.json", "e.json", "--parameters", "x.initial", "--json", "measured.csv"},
            "--json",
            "measured.csv"},
           {{"diagnose", "top.json", "e.json", "--report", "measured.csv"}, "--report", "measured.csv"},
           {{"gp", "train", "t.json", "--model", "measured.csv"}, "--model", "measured.csv"},
           {{"deploy", "top.json", "--report", "data.csv"}, "--report", "data.csv"},
           {{"sweep", "s.json", "-o", "tables"}, "--output", "results.csv"}}) {
    const Outcome outcome = run(c.arguments);
    const std::string what = ::testing::PrintToString(c.arguments) + "\n" + outcome.err;
    EXPECT_EQ(outcome.code, 2) << what;
    EXPECT_TRUE(contains(outcome.err, c.option) && contains(outcome.err, c.file)) << what;
    EXPECT_TRUE(contains(outcome.err, "names the same file, and would replace it")) << what;
    EXPECT_TRUE(contents() == before) << what;
  }
}

TEST_F(SharedFiles, AFileThatAnOptionNamesIsNoOutput) {
  folder.with("blocks.so", "").with("c.csv", "").with("log.csv.journal", "");
  fs::create_hard_link(folder.path("c.csv"), folder.path("linked.csv"));
  fs::create_hard_link(folder.path("top.json"), folder.path("linked.json"));
  fs::create_hard_link(folder.path("log.csv.journal"), folder.path("linked.mat"));
  for (const Arguments& arguments :
       std::vector<Arguments>{{"run", "top.json", "--blocks", "blocks.so", "--report", "blocks.so"},
                              {"run", "top.json", "--resume", "c.csv", "-o", "linked.csv"},
                              {"run", "top.json", "--report", "linked.json"},
                              {"gp", "show", "top.json", "--report", "linked.json"},
                              {"gp", "show", "m.json", "--on", "top.json", "--json", "linked.json"},
                              {"recover", "log.csv.journal", "-o", "linked.mat"},
                              {"run", "top.json", "-o", "c.csv", "--report", "linked.csv"}}) {
    const auto before = contents();
    const Outcome outcome = run(arguments);
    const std::string what = ::testing::PrintToString(arguments) + "\n" + outcome.err;
    EXPECT_EQ(outcome.code, 2) << what;
    EXPECT_TRUE(contains(outcome.err, "name the same file")) << what;
    EXPECT_TRUE(contents() == before) << what;
  }
}

TEST_F(SharedFiles, TheJournalOfALogIsNoOtherResult) {
  for (const Arguments& more : std::vector<Arguments>{{"-o", "log.csv", "--json", "log.csv.journal"},
                                                      {"-o", "log.csv", "--report", "./log.csv.journal"},
                                                      {"--report", "r.html", "--json", "r.html.journal"}}) {
    Arguments arguments{"deploy", "top.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, more[2] + " " + more[3] + " is the journal of the log")) << outcome.err;
  }
}

TEST_F(SharedFiles, ACheckpointMayTakeThePlaceOfTheOneThatTheRunGoesOnFrom) {
  ASSERT_EQ(
      run({"run", "top.json", "-q", "-o", "whole.csv", "--checkpoint", "c", "--checkpoint-every", "0.375"})
          .code,
      0);
  const Outcome outcome = run({"run", "top.json", "-q", "-o", "rest.csv", "--resume", "c", "--checkpoint",
                               "./c", "--checkpoint-every", "0.125"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(text_of(folder.path("rest.csv")), text_of(folder.path("whole.csv")));
}

TEST_F(SharedFiles, AResultReplacesTheOneBefore) {
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(run({"run", "top.json", "-q", "-o", "o.csv", "--report", "o.html"}).code, 0) << i;
}

}  // namespace
}  // namespace loopwright::shared_files_test
