// Output streams: summaries go to stdout, or to stderr if a result uses stdout; progress and problems go to
// stderr.
#include <gtest/gtest.h>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include "tests/tools/command/program.h"

namespace loopwright::streams_test {
namespace {

/// A mass under viscous friction, driven by a recorded force, and the files that belong to it.
class Streams : public ::testing::Test {
 protected:
  void SetUp() override {
    if (access(program().c_str(), X_OK) != 0) GTEST_SKIP() << program() << " is not built";
    folder.with("axis.json", R"({"loopwright": 1, "title": "Axis",
  "parameters": {"mass": {"value": 1.5, "unit": "kg"}},
  "solver": {"method": "rk4", "step": 0.01, "stop": 1},
  "blocks": {
    "push":      {"type": "Constant", "value": {"value": 1, "unit": "N"}},
    "motor":     {"type": "Gain", "gain": {"value": 1, "unit": "1"}, "in": {"u": "push.y"}},
    "viscous":   {"type": "ViscousFriction", "damping": {"value": 3, "unit": "N*s/m"}, "in": {"velocity": "mass.velocity"}},
    "net_force": {"type": "Sum", "signs": "+-", "in": {"terms": ["motor.y", "viscous.force"]}},
    "mass":      {"type": "Mass", "mass": "=mass", "initial_position": {"value": 0, "unit": "m"}, "in": {"force": "net_force.sum"}}
  }})");
    folder.with("e.json", R"({"loopwright": 1, "data": "data.csv", "time": "t",
  "drive": {"motor.u": {"column": "u", "unit": "N", "interpolation": "linear"}},
  "compare": {"mass.position": {"column": "x", "unit": "m"}},
  "roles": {"position": "mass.position", "velocity": "mass.velocity", "force": "net_force.sum", "input": "motor.u"}})");
    std::string text = "t,u,x\n";
    double x = 0, v = 0;
    for (int k = 0; k <= 2000; ++k) {
      const double t = k * 0.01, u = std::sin(2 * t) + 0.5 * std::sin(5 * t);
      text += fmt::format("{:.2f},{:.12g},{:.9g}\n", t, u, x + 1e-5 * std::sin(1e4 * t * t));
      for (int i = 0; i < 10; ++i)
        x += 0.001 * v, v += 0.001 * (std::sin(2 * t) + 0.5 * std::sin(5 * t) - 3 * v) / 2;
    }
    folder.with("data.csv", text);
    folder.with("s.json", R"({"loopwright": 1, "diagram": "axis.json", "axes": {"mass": {"values": [1, 2]}},
  "metrics": {"end": {"final": "mass.position"}}})");
  }
  Outcome run(std::vector<std::string> arguments) const {
    return loopwright_program(std::move(arguments), folder.path(""));
  }
  DiagramFolder folder;
};

TEST_F(Streams, SummariesGoToStdout) {
  using Arguments = std::vector<std::string>;
  for (const auto& [arguments, part] : std::vector<std::pair<Arguments, std::string>>{
           {{"run", "axis.json"}, "done: 1 of 1 s"},
           {{"check", "axis.json"}, "axis.json: fine"},
           {{"plan", "axis.json"}, "order"},
           {{"compare", "axis.json", "e.json"}, "mass.position"},
           {{"compare", "axis.json", "e.json", "--json", "c.json"}, "mass.position"},
           {{"fit", "axis.json", "e.json", "--parameters", "mass"}, "95 % interval"},
           {{"fit", "axis.json", "e.json", "--parameters", "mass", "-o", "f.json"}, "95 % interval"},
           {{"diagnose", "axis.json", "e.json"}, ""},
           {{"linearize", "axis.json", "--continuous"}, ""},
           {{"sweep", "s.json", "-o", "results"}, "2 of 2 runs done"},
           {{"sweep", "merge", "results"}, "results.csv"},
           {{"sweep", "report", "results"}, "report.html"},
           {{"sweep", "s.json", "--minimize", "end", "--evaluations", "2"}, "least end"},
           {{"blocks"}, "Gain"},
           {{"schema"}, "\"$defs\""}}) {
    const Outcome outcome = run(arguments);
    const std::string what = ::testing::PrintToString(arguments) + outcome.out + outcome.err;
    EXPECT_EQ(outcome.code, 0) << what;
    EXPECT_NE(outcome.out, "") << what;
    EXPECT_TRUE(contains(outcome.out, part)) << what;
    EXPECT_FALSE(contains(outcome.err, part) && !part.empty()) << what;
  }
}

TEST_F(Streams, WhereAResultTakesStdoutTheSummaryGoesToStderr) {
  const Outcome rows = run({"run", "axis.json", "-o", "-"});
  EXPECT_TRUE(rows.out.starts_with("#") || rows.out.starts_with("time")) << rows.out.substr(0, 80);
  EXPECT_FALSE(contains(rows.out, "done:"));
  EXPECT_TRUE(contains(rows.err, "done: 1 of 1 s")) << rows.err;
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"compare", "axis.json", "e.json", "--json", "-"},
           {"fit", "axis.json", "e.json", "--parameters", "mass", "--json", "-"},
           {"fit", "axis.json", "e.json", "--parameters", "mass", "-o", "-"},
           {"diagnose", "axis.json", "e.json", "--json", "-"},
           {"linearize", "axis.json", "--continuous", "--json", "-"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(nlohmann::json::accept(outcome.out)) << ::testing::PrintToString(arguments) << outcome.out;
    EXPECT_NE(outcome.err, "") << ::testing::PrintToString(arguments);
  }
  const Outcome csv =
      run({"linearize", "axis.json", "--from", "motor.u", "--to", "mass.position", "--csv", "-"});
  EXPECT_EQ(csv.code, 0) << csv.err;
  EXPECT_TRUE(contains(csv.out, "frequency")) << csv.out;
  EXPECT_NE(csv.err, "");
}

TEST_F(Streams, SettingsThatAWrittenDiagramDoesNotContainAreNamed) {
  const std::vector<std::string> fit{"fit", "axis.json", "e.json", "--parameters", "mass", "-o", "f.json"};
  EXPECT_FALSE(contains(run(fit).err, "warning")) << run(fit).err;
  std::vector<std::string> changed = fit;
  changed.insert(changed.end(), {"--set", "solver.stop=0.9"});
  const Outcome outcome = run(changed);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(
      contains(outcome.err, "f.json was written from axis.json and does not contain --set solver.stop=0.9"))
      << outcome.err;
  changed.back() = "mass=1";  // where the fit begins: the file holds what it found
  EXPECT_FALSE(contains(run(changed).err, "warning")) << run(changed).err;
}

TEST_F(Streams, TwoResultsOnStdoutAndFilesThatAreNoneAreRefused) {
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"linearize", "axis.json", "--from", "motor.u", "--to", "mass.position", "--csv", "-", "--json",
            "-"},
           {"fit", "axis.json", "e.json", "--parameters", "mass", "-o", "-", "--json", "-"},
           {"run", "axis.json", "--report", "-"},
           {"diagnose", "axis.json", "e.json", "-o", "-"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << ::testing::PrintToString(arguments) << outcome.err;
    EXPECT_EQ(outcome.out, "") << ::testing::PrintToString(arguments);
  }
}

TEST_F(Streams, AFitIntoAnotherFolderTouchesNumbersOnly) {
  for (const char* unit_or_name : {"m", "N", "kg", "1", "axis", "Mass", "mass.velocity", "out/unused"})
    folder.with(unit_or_name, "a file that happens to be called so");
  const Outcome outcome = run({"fit", "axis.json", "e.json", "--parameters", "mass", "-o", "out/f.json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::string before = text_of(folder.path("axis.json")), after = text_of(folder.path("out/f.json"));
  const std::string beginning = "\"mass\": {\"value\": ";
  for (std::string* text : {&before, &after}) {
    const size_t number = text->find(beginning) + beginning.size();
    text->erase(number, text->find(',', number) - number);
  }
  EXPECT_EQ(before, after);
  EXPECT_EQ(run({"check", "out/f.json"}).code, 0);
}

TEST_F(Streams, ArgumentsInEachOthersPlaceAreToldAsThat) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"compare", "e.json", "axis.json"},
                                             {"diagnose", "e.json", "axis.json"},
                                             {"fit", "e.json", "axis.json", "--parameters", "mass"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_TRUE(contains(outcome.err, "stand in each other's place") &&
                contains(outcome.err, "axis.json e.json") && contains(outcome.err, "1 error"))
        << outcome.err;
  }
  const Outcome wrong = run({"run", "e.json"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_TRUE(contains(wrong.err, "e.json:1:") &&
              contains(wrong.err, "this is an experiment, not a diagram") &&
              contains(wrong.err, "loopwright compare") && contains(wrong.err, "1 error"))
      << wrong.err;
}

TEST_F(Streams, WrongNamesOfAllKindsAreToldAtOnce) {
  folder.with("wrong.json", R"({"loopwright": 1, "data": "data.csv", "time": "t",
  "drive": {"moter.u": {"column": "uu", "unit": "N"}},
  "compare": {"mass.positon": {"column": "xx", "unit": "m"}},
  "roles": {"position": "mass.position", "velocity": "mass.velocty"}})");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"compare", "axis.json", "wrong.json"},
                                             {"diagnose", "axis.json", "wrong.json"},
                                             {"fit", "axis.json", "wrong.json", "--parameters", "mas"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2);
    for (const char* part : {"moter", "did you mean \"motor\"?", "\"uu\"", "\"xx\"",
                             "did you mean \"mass.position\"?", "did you mean \"mass.velocity\"?"})
      EXPECT_TRUE(contains(outcome.err, part)) << part << outcome.err;
    EXPECT_TRUE(arguments[0] != "fit" || contains(outcome.err, "did you mean \"mass\"?")) << outcome.err;
    EXPECT_FALSE(contains(outcome.err, "recorded_")) << outcome.err;
  }
}

}  // namespace
}  // namespace loopwright::streams_test
