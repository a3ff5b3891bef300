// Failures found by mutants: each was a crash, an exception, a silent success or a message without source
// location.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "engine/run/simulation.h"
#include "tests/engine/diagram/diagram_folder.h"

namespace loopwright::found_test {
namespace {

/// Every problem of a diagram around these blocks, as text.
std::string problems_of(const std::string& blocks, const std::string& solver = R"("stop": 1)") {
  DiagramFolder folder;
  folder.with("top.json", R"({"loopwright": 1, "solver": {)" + solver + R"(},
"blocks": {)" + blocks + "}}");
  try {
    load_plan(folder.path("top.json"));
    return "";
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems.list())
      EXPECT_TRUE(problem.place.file) << to_string(problem);
    return error.what();
  }
}
void expect_in(const std::string& part, const std::string& text) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

constexpr const char* constant = R"("c": {"type": "Constant", "value": 1}, )";

TEST(Found, ATolerancePastWhatTheSolverTakesIsAProblemOfTheDiagram) {
  for (const char* tolerance : {"1e-14", "1", "1000"}) {
    const std::string text =
        problems_of(R"("c": {"type": "Constant", "value": 1})",
                    std::string(R"("method": "dopri5", "stop": 1, "relative_tolerance": )") + tolerance);
    expect_in("top.json:1:", text);
    expect_in("\"relative_tolerance\" is out of range", text);
    expect_in("at least 1e-13 and below 1", text);
  }
}

TEST(Found, AnAbsoluteToleranceWhoseSquareIsZeroIsAProblemOfTheDiagram) {
  for (const char* method : {"dopri5", "cvode-bdf", "cvode-adams"}) {
    const std::string solver =
        R"("stop": 1, "method": ")" + std::string(method) + R"(", "absolute_tolerance": )";
    const std::string state = R"("x": {"type": "Integrator", "in": {"u": "x.y"}})";
    expect_in("\"absolute_tolerance\" is out of range", problems_of(state, solver + "5e-324"));
    EXPECT_EQ(problems_of(state, solver + "1e-100"), "");
  }
}

TEST(Found, AWireThatLeadsNowhereLeavesThePlaceOfTheBlock) {
  const std::string text = problems_of(
      R"("c": {"type": "NoSuch"}, "s": {"type": "Expression", "formula": "1", "names": [], "in": {"arguments": ["c.y", "c.y"]}})");
  expect_in("top.json:2:", text);
}

TEST(Found, AnEmptyListOfWiresIsNotWired) {
  for (const char* block :
       {R"("type": "Sum", "signs": "+-", "in": {"terms": []})", R"("type": "Sum", "in": {"terms": []})",
        R"("type": "Maximum", "in": {"terms": []})", R"("type": "Pack", "in": {"elements": []})"})
    expect_in("is not wired", problems_of(std::string(constant) + "\"s\": {" + block + "}"));
  EXPECT_EQ(problems_of(
                R"("s": {"type": "Expression", "formula": "2 * pi", "names": [], "in": {"arguments": []}})"),
            "");
}

TEST(Found, DiscontinuitiesWithoutEndEndTheRun) {
  DiagramFolder folder;
  folder.with("top.json", R"({"loopwright": 1, "solver": {"method": "dopri5", "stop": 1},
    "blocks": {"p": {"type": "PulseTrain", "period": 1e-300, "width": 0}, "x": {"type": "Integrator", "in": {"u": "p.y"}}}})");
  const RunResult result = simulate(*load_plan(folder.path("top.json")));
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_THAT(result.message, ::testing::HasSubstr("known discontinuities"));
}

TEST(Found, AVectorThatDoublesInARingIsTooLong) {
  for (const char* more :
       {R"("p.y")", R"("p.y", "p.y")", R"("p.y", "p.y", "p.y", "p.y", "p.y", "p.y", "p.y", "p.y")"}) {
    const std::string text =
        problems_of(R"("p": {"type": "Pack", "in": {"elements": ["p.y", )" + std::string(more) + "]}}");
    expect_in("top.json:2:", text);
    expect_in("its vectors", text);
  }
}

TEST(Found, MoreMemoryThanAMachineHasIsAProblemOfTheDiagram) {
  std::string wires;
  for (int i = 0; i < 300; ++i) wires += i ? R"(, "c.y")" : R"("c.y")";
  const std::string text = problems_of(
      std::string(constant) + R"("p": {"type": "Pack", "in": {"elements": [)" + wires +
      R"(]}}, "d": {"type": "Delay", "samples": 10000000, "sample_time": 0.1, "in": {"u": "p.y"}})");
  expect_in("the diagram needs 24 GB of memory", text);
  expect_in("block: d", text);
}

TEST(Found, ARecordingTooLargeForTheMemoryIsAProblemOfTheSolverSettings) {
  DiagramFolder folder;
  folder.with("top.json", R"({"loopwright": 1,
"solver": {"stop": 1000000, "record_step": 1e-6, "step": 1e-6}, "blocks": {"x": {"type": "Integrator", "in": {"u": "x.y"}}}})");
  try {
    simulate(*load_plan(folder.path("top.json")));
    FAIL() << "the recording would have more rows than a memory holds";
  } catch (const InputError& error) {
    expect_in("top.json:2:", error.what());
    expect_in("the recording would take", error.what());
  }
}

TEST(Found, AStopTimeFromOutsideLeavesThePlaceOfTheSolverSettings) {
  DiagramFolder folder;
  folder.with("top.json", R"({"loopwright": 1,
"solver": {"step": 1e-9}, "blocks": {"x": {"type": "Integrator", "in": {"u": "x.y"}}}})");
  LoadOptions options;
  options.set = {{"solver.stop", "1e8 s"}};
  try {
    load_plan(folder.path("top.json"), options);
    FAIL() << "the ticks cannot be counted";
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems.list())
      EXPECT_TRUE(problem.place.file) << to_string(problem);
    expect_in("more than can be counted exactly", error.what());
  }
}

}  // namespace
}  // namespace loopwright::found_test
