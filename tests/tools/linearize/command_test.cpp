/// `loopwright linearize` from outside: exit codes, output files, and their contents.
#include <gmock/gmock.h>
#include <filesystem>
#include <nlohmann/json.hpp>
#include "tests/tools/command/program.h"

namespace loopwright::command_test {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A loop around 1/(s (s + 2)) with gain 5: natural frequency √5 rad/s, damping 1/√5.
constexpr const char* loop =
    R"({"loopwright": 1, "title": "Servo", "solver": {"stop": 1, "step": 0.001}, "blocks": {
  "wish":  {"type": "Constant", "value": 1},
  "error": {"type": "Sum", "signs": "+-", "in": {"terms": ["wish.y", "x.y"]}},
  "gain":  {"type": "Gain", "gain": 5, "in": {"u": "error.sum"}},
  "net":   {"type": "Sum", "signs": "+-", "in": {"terms": ["gain.y", "drag.y"]}},
  "drag":  {"type": "Gain", "gain": 2, "in": {"u": "v.y"}},
  "v":     {"type": "Integrator", "in": {"u": "net.sum"}},
  "x":     {"type": "Integrator", "in": {"u": "v.y"}}}, "log": ["x.y"]})";
constexpr const char* diverging = R"({"loopwright": 1, "solver": {"stop": 10, "step": 0.01}, "blocks": {
  "x": {"type": "Integrator", "initial": 1, "in": {"u": "p.product"}}, "p": {"type": "Product", "in": {"factors": ["x.y", "x.y"]}}}})";

class LinearizeCommand : public ::testing::Test {
 protected:
  void SetUp() override { folder.with("loop.json", loop).with("diverging.json", diverging); }
  Outcome linearize(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "linearize");
    return loopwright_program(std::move(arguments), folder.path(""));
  }
  size_t files() const { return size_t(std::distance(fs::directory_iterator(folder.path("")), {})); }
  DiagramFolder folder;
};

TEST_F(LinearizeCommand, WritesFiguresResponsesAndAPage) {
  const Outcome outcome =
      linearize({"loop.json", "--from", "gain.u", "--to", "x.y", "--break", "gain.u", "--continuous",
                 "--json", "out.json", "--csv", "out.csv", "--report", "out.html"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out, "") << "the summary";
  const auto json = nlohmann::json::parse(text_of(folder.path("out.json")));
  for (const char* key :
       {"title", "plan", "sample_time", "states", "A", "B", "C", "D", "poles", "zeros", "notes"})
    EXPECT_TRUE(json.contains(key)) << key;
  ASSERT_EQ(json["poles"].size(), 2u);
  for (const auto& pole : json["poles"]) {
    EXPECT_NEAR(pole["re"].get<double>(), -1, 1e-9);
    EXPECT_NEAR(std::abs(pole["im"].get<double>()), 2, 1e-9);
  }
  EXPECT_TRUE(json["loop"]["is_stable"].get<bool>());
  EXPECT_EQ(json["response"]["channels"][0]["to"], "x.y");
  EXPECT_THAT(text_of(folder.path("out.csv")), HasSubstr("frequency"));
  const std::string page = text_of(folder.path("out.html"));
  for (const char* part : {"Servo", "Phase", "Nyquist", "</html>"}) EXPECT_THAT(page, HasSubstr(part));
}

TEST_F(LinearizeCommand, ADashPutsTheFiguresOnStdout) {
  const Outcome outcome = linearize({"loop.json", "--continuous", "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["poles"].size(), 2u);
}

TEST_F(LinearizeCommand, AnswersTwoToWrongInputAndLeavesNothing) {
  const size_t before = files();
  const Outcome port = linearize(
      {"loop.json", "--from", "gain.x", "--to", "x.z", "--json", "out.json", "--report", "out.html"});
  EXPECT_EQ(port.code, 2);
  for (const char* part : {"gain.x", "x.z", "did you mean"}) EXPECT_THAT(port.err, HasSubstr(part));
  EXPECT_EQ(linearize({"loop.json", "--csv", "out.csv"}).code, 2);
  EXPECT_EQ(linearize({"loop.json", "--json", "no/such/folder.json"}).code, 2);
  EXPECT_EQ(linearize({"missing.json"}).code, 2);
  EXPECT_EQ(linearize({"loop.json", "--at", "-1"}).code, 2);
  EXPECT_EQ(files(), before);
}

TEST_F(LinearizeCommand, AnswersOneWhenTheRunToTheOperatingPointFails) {
  const size_t before = files();
  const Outcome outcome = linearize({"diverging.json", "--at", "5", "--json", "out.json"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("the run diverged"));
  EXPECT_EQ(files(), before);
}

/// A mass whose speed a sampled controller holds.
constexpr const char* sampled =
    R"({"loopwright": 1, "solver": {"stop": 1, "step": 0.001}, "blocks": {
  "gain": {"type": "Gain", "gain": -20, "in": {"u": "hold.y"}},
  "hold": {"type": "ZeroOrderHold", "sample_time": 0.01, "in": {"u": "v.y"}},
  "v":    {"type": "Integrator", "in": {"u": "gain.y"}}}})";

TEST_F(LinearizeCommand, MeasuresTheSystemThatItDraws) {
  folder.with("sampled.json", sampled);
  const Outcome held =
      linearize({"sampled.json", "--from", "v.u", "--to", "v.y", "--continuous", "--measure", "1"});
  EXPECT_EQ(held.code, 2);
  EXPECT_THAT(held.err, HasSubstr("--measure and --continuous show different systems"));
  // Without the loop around it the drag alone remains: 1/(jω + 2).
  const Outcome open = linearize({"loop.json", "--from", "net.terms[0]", "--to", "v.y", "--open",
                                  "net.terms[0]", "--measure", "1", "--settle", "5", "--json", "open.json"});
  ASSERT_EQ(open.code, 0) << open.err;
  const auto json = nlohmann::json::parse(text_of(folder.path("open.json")));
  ASSERT_EQ(json["measured"].size(), json["sines"].get<size_t>());
  const double w = json["measured"][0]["frequency"].get<double>();
  EXPECT_NEAR(json["measured"][0]["gain"].get<double>(), 1 / std::hypot(w, 2), 1e-3);
}

TEST_F(LinearizeCommand, RefusesSinesThatDoNotSettle) {
  folder.with("open.json", R"({"loopwright": 1, "solver": {"stop": 1, "step": 0.001}, "blocks": {
  "zero": {"type": "Constant", "value": 0},
  "net": {"type": "Sum", "in": {"terms": ["zero.y", "v.y"]}},
  "v": {"type": "Integrator", "in": {"u": "net.sum"}}}})");
  const Outcome outcome = linearize({"open.json", "--from", "net.terms[0]", "--to", "v.y", "--measure", "1"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("s = 1"));
}

/// Sends Ctrl-C when the program is at work.
Outcome interrupted_outcome(std::vector<std::string> arguments, const std::string& folder) {
  Program program(std::move(arguments), folder);
  usleep(1'500'000);
  program.send(SIGINT);
  return program.wait();
}

TEST_F(LinearizeCommand, AnswersAnInterruptionWith130) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"linearize", "loop.json", "--at", "1000000", "--set",
                                 "solver.record_step=1"},
        {"linearize", "loop.json", "--from", "gain.u", "--to", "x.y", "--measure", "1", "--settle", "100000",
         "--json", "out.json"}}) {
    const Outcome outcome = interrupted_outcome(arguments, folder.path(""));
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    EXPECT_THAT(outcome.err + outcome.out, HasSubstr("interrupted"));
    EXPECT_THAT(outcome.err, ::testing::Not(HasSubstr("error")));
  }
  const auto json = nlohmann::json::parse(text_of(folder.path("out.json")));
  EXPECT_GT(json["sines"].get<size_t>(), json.value("measured", nlohmann::json::array()).size());
}

}  // namespace
}  // namespace loopwright::command_test
