// `loopwright gp` from outside: exit codes, files, and that an error leaves no files.
#include <gtest/gtest.h>
#include <filesystem>
#include "tests/tools/command/program.h"
#include "tests/tools/gp/stage.h"

namespace loopwright::command_test {
namespace {

class GpCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    if (access(program().c_str(), X_OK) != 0) GTEST_SKIP() << program() << " is not built";
    folder.pass("pass.csv", {0.1, 0.2, 0.3, 0.4}).training();
  }
  Outcome gp(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "gp");
    return loopwright_program(std::move(arguments), folder.path(""));
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder.path(name)); }
  StageFolder folder;
};

TEST_F(GpCommand, TrainsAModelThatItCanShow) {
  const Outcome trained =
      gp({"train", "t.training.json", "--model", "stage.model.json", "--report", "t.html"});
  EXPECT_EQ(trained.code, 0) << trained.err;
  EXPECT_NE(trained.out.find("terms.0.position.length"), trained.out.npos) << trained.out;
  EXPECT_TRUE(exists("stage.model.json") && exists("t.html"));
  const Outcome shown = gp({"show", "stage.model.json", "--on", "t.training.json", "--json", "-"});
  EXPECT_EQ(shown.code, 0) << shown.err;
  EXPECT_TRUE(shown.out.starts_with("{")) << shown.out;
  EXPECT_NE(shown.out.find("\"t.training.json\""), shown.out.npos) << "the score on these samples";
}

TEST_F(GpCommand, AnswersTwoAndLeavesNothingBehindWhenTheInputIsWrong) {
  const Outcome outcome =
      gp({"train", "t.training.json", "--model", "stage.model.json", "--set", "kernel=pe"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("\"product\""), outcome.err.npos) << outcome.err;
  EXPECT_FALSE(exists("stage.model.json"));
  EXPECT_EQ(gp({"train", "t.training.json", "--model", "nowhere/stage.model.json"}).code, 2);
  EXPECT_EQ(gp({"show", "missing.model.json"}).code, 2);
  EXPECT_EQ(gp({"show", "t.training.json"}).code, 2) << "a training file is no model";
}

}  // namespace
}  // namespace loopwright::command_test
