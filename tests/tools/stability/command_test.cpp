/// `loopwright stability` from outside: exit codes, output files, and their contents.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <filesystem>
#include <nlohmann/json.hpp>
#include "tests/tools/command/program.h"

namespace loopwright::command_test {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A sampled PD loop around a mass with viscous friction. `gain` alone determines its stability.
std::string servo(double gain, const std::string& controller = "PdController") {
  return fmt::format(
      R"({{"loopwright": 1, "title": "Servo", "solver": {{"stop": 0.5, "step": 0.001}}, "blocks": {{
  "wish":     {{"type": "Sine", "amplitude": 0.01, "frequency": 6}},
  "feedback": {{"type": "{}", "sample_time": 0.001, "Kp": {}, "Kd": 60, "derivative_pole": 900,
               "in": {{"reference": "wish.y", "measured": "plant.position"}}}},
  "force":    {{"type": "Sum", "signs": "+-", "in": {{"terms": ["feedback.command", "friction.force"]}}}},
  "friction": {{"type": "ViscousFriction", "damping": 2.4, "in": {{"velocity": "plant.velocity"}}}},
  "plant":    {{"type": "Mass", "mass": 0.26, "in": {{"force": "force.sum"}}}}}}, "log": ["plant.position"]}})",
      controller, gain);
}

class StabilityCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    folder.with("servo.json", servo(4000))
        .with("unstable.json", servo(-4000))
        .with("diverging.json", servo(4e8))
        .with(
            "no_loop.json",
            R"({"loopwright": 1, "solver": {"stop": 1}, "blocks": {"c": {"type": "Constant", "value": 1}}})");
  }
  Outcome stability(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "stability");
    return loopwright_program(std::move(arguments), folder.path(""));
  }
  size_t files() const { return size_t(std::distance(fs::directory_iterator(folder.path("")), {})); }
  DiagramFolder folder;
};

TEST_F(StabilityCommand, WritesFiguresAndAPage) {
  const Outcome outcome = stability({"servo.json", "--json", "out.json", "--report", "out.html"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out, "") << "the summary";
  const auto json = nlohmann::json::parse(text_of(folder.path("out.json")));
  for (const char* key : {"title", "plan", "certified", "alpha", "disturbance", "position", "learned",
                          "linear_part", "margins", "A", "B", "nonlinearities", "kicks", "warnings"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_TRUE(json["certified"].get<bool>());
  EXPECT_TRUE(json["A"]["holds"].get<bool>());
  EXPECT_LT(json["linear_part"]["largest_pole"].get<double>(), 1);
  ASSERT_EQ(json["kicks"].size(), 1u);
  EXPECT_TRUE(json["kicks"][0]["decays"].get<bool>());
  const std::string page = text_of(folder.path("out.html"));
  for (const char* part : {"Servo", "ertificate", "ick", "</html>"}) EXPECT_THAT(page, HasSubstr(part));
}

TEST_F(StabilityCommand, SaysOfAnUnstableLoopThatItIsNotCertified) {
  const Outcome outcome = stability({"unstable.json", "--no-kicks", "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_FALSE(json["certified"].get<bool>());
  EXPECT_FALSE(json["A"]["holds"].get<bool>());
  EXPECT_GT(json["linear_part"]["largest_pole"].get<double>(), 1);
  EXPECT_TRUE(json["kicks"].empty());
}

TEST_F(StabilityCommand, AnswersTwoToWrongInputAndLeavesNothing) {
  const size_t before = files();
  const Outcome port = stability({"servo.json", "--disturbance", "plant.forse", "--json", "out.json"});
  EXPECT_EQ(port.code, 2);
  EXPECT_THAT(port.err, HasSubstr("plant.force"));
  EXPECT_EQ(stability({"no_loop.json", "--report", "out.html"}).code, 2);
  EXPECT_EQ(stability({"servo.json", "--report", "no/such/folder.html"}).code, 2);
  EXPECT_EQ(stability({"missing.json"}).code, 2);
  EXPECT_EQ(files(), before);
}

TEST_F(StabilityCommand, AnswersOneWhenTheRunFails) {
  const size_t before = files();
  const Outcome outcome = stability({"diverging.json", "--json", "out.json"});
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("diverged"));
  EXPECT_EQ(files(), before);
}

TEST_F(StabilityCommand, AnswersAnInterruptionWith130) {
  Program program({"stability", "servo.json", "--set", "solver.stop=1000000", "--set", "solver.record_step=1",
                   "--json", "out.json"},
                  folder.path(""));
  usleep(1'500'000);
  program.send(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("interrupted at t ="));
  EXPECT_THAT(outcome.err, ::testing::Not(HasSubstr("error")));
}

}  // namespace
}  // namespace loopwright::command_test
