// A new project does what its README says: every command of it runs, and the model finds what its machine
// hides.
#include <gmock/gmock.h>
#include <filesystem>
#include <nlohmann/json.hpp>
#include "tests/tools/command/program.h"

namespace loopwright::new_project_test {
namespace {

namespace fs = std::filesystem;
using ::testing::DoubleNear;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

class NewProject : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const Outcome made = loopwright_program({"new", "axis", "--from", GetParam()}, folder.path(""));
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_THAT(made.out, HasSubstr("cd axis && loopwright run nominal.json"));
    run_commands_of_readme();
  }
  void run_commands_of_readme() {
    std::istringstream readme(text_of(folder.path("axis/README.md")));
    bool is_command = false;
    int commands = 0;
    for (std::string line; std::getline(readme, line);) {
      if (line.starts_with("```")) {
        is_command = line == "```sh";
        continue;
      }
      if (!is_command) continue;
      std::istringstream words(line);
      std::vector<std::string> arguments;
      for (std::string word; words >> word;) arguments.push_back(word);
      ASSERT_EQ(arguments.at(0), "loopwright");
      arguments.erase(arguments.begin());
      const Outcome outcome = loopwright_program(arguments, folder.path("axis"));
      ASSERT_EQ(outcome.code, 0) << line << "\n" << outcome.err;
      ++commands;
    }
    EXPECT_GE(commands, 5);
  }
  nlohmann::json json_of(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--json", "-"});
    return nlohmann::json::parse(loopwright_program(arguments, folder.path("axis")).out);
  }
  DiagramFolder folder;
};

class NewAxis : public NewProject {};
TEST_P(NewAxis, ItsDiagnosisFindsTheFrictionAndTheCoggingOfTheMachine) {
  const auto found = json_of({"diagnose", "nominal.json", "trial.experiment.json"});
  EXPECT_EQ(found["verdict"], "explained");
  std::vector<std::string> effects;
  for (const auto& effect : found["effects"]) effects.push_back(effect["effect"]);
  EXPECT_THAT(effects, UnorderedElementsAre("coulomb_friction", "cogging"));
  EXPECT_TRUE(fs::exists(folder.path("axis/improved.json")));
}
INSTANTIATE_TEST_SUITE_P(Kinds, NewAxis, testing::Values("linear_motor", "servo"));

class NewPlant : public NewProject {};
TEST_P(NewPlant, ItsFitFindsTheParametersOfTheMachine) {
  const std::map<std::string, std::map<std::string, double>> machines = {
      {"pendulum", {{"plant.l", 0.43}, {"plant.d", 1.4}}},
      {"thermal", {{"plant.capacity", 1050}, {"plant.conductance", 1.15}}}};
  const auto& machine = machines.at(GetParam());
  std::string paths;
  for (const auto& [path, value] : machine) paths += (paths.empty() ? "" : ",") + path;
  const auto found = json_of({"fit", "nominal.json", "trial.experiment.json", "--parameters", paths});
  for (const auto& [path, value] : machine)
    EXPECT_THAT(double(found["parameters"][path]["value"]), DoubleNear(value, 1e-4 * value)) << path;
}
INSTANTIATE_TEST_SUITE_P(Kinds, NewPlant, testing::Values("pendulum", "thermal"));

TEST(New, RefusesAFolderThatExists) {
  DiagramFolder folder;
  folder.with("axis/notes.txt", "mine");
  const Outcome outcome = loopwright_program({"new", "axis"}, folder.path(""));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("\"axis\" exists already"));
  EXPECT_EQ(text_of(folder.path("axis/notes.txt")), "mine");
  EXPECT_FALSE(fs::exists(folder.path("axis/nominal.json")));
}

TEST(New, TouchesNoOtherFolder) {
  DiagramFolder folder;
  folder.with("axis.part/notes.txt", "mine").with("axis.part/nominal.json", "mine too");
  const Outcome outcome = loopwright_program({"new", "axis"}, folder.path(""));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(text_of(folder.path("axis.part/notes.txt")), "mine");
  EXPECT_EQ(text_of(folder.path("axis.part/nominal.json")), "mine too");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path("")), {}), 2);
}

TEST(New, RecognizesAMisspeltKindAndLeavesNothingBehind) {
  DiagramFolder folder;
  const Outcome outcome = loopwright_program({"new", "axis/", "--from", "pendulm"}, folder.path(""));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("did you mean \"pendulum\"?"));
  EXPECT_TRUE(fs::is_empty(folder.path("")));
  const Outcome unwritable = loopwright_program({"new", "no/such/folder"}, folder.path(""));
  EXPECT_EQ(unwritable.code, 2);
  EXPECT_TRUE(fs::is_empty(folder.path("")));
}

}  // namespace
}  // namespace loopwright::new_project_test
