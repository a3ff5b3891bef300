// Libraries of blocks: one that works, and those that are rejected with exit code 2 instead of an abort.
#include <gtest/gtest.h>
#include "tests/tools/command/program.h"

namespace loopwright::plugin_test {
namespace {

const std::string libraries = LOOPWRIGHT_BINARY "/lib/plugins/";

class Plugin : public ::testing::Test {
 protected:
  void SetUp() override {
    if (access(program().c_str(), X_OK) != 0) GTEST_SKIP() << program() << " is not built";
    if (access((libraries + "plugin_own.so").c_str(), R_OK) != 0)
      GTEST_SKIP() << "the libraries are not built";
    folder.with("d.json", R"({"loopwright": 1, "solver": {"stop": 1, "step": 0.5}, "blocks": {
  "c": {"type": "Constant", "value": 21}, "d": {"type": "Doubled", "in": {"u": "c.y"}}}})");
    folder.with("s.json", R"({"loopwright": 1, "diagram": "d.json", "axes": {"c.value": {"values": [1, 2]}},
  "metrics": {"end": {"final": "d.y"}}})");
  }
  Outcome run(std::vector<std::string> arguments) const {
    return loopwright_program(std::move(arguments), folder.path(""));
  }
  void is_refused(const std::string& library, const std::vector<std::string>& told) const {
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"blocks", "Gain", "--blocks", library},
                                               {"check", "d.json", "--blocks", library},
                                               {"sweep", "s.json", "-o", "r", "--blocks", library}}) {
      const Outcome outcome = run(arguments);
      EXPECT_EQ(outcome.code, 2) << outcome.err;
      EXPECT_EQ(outcome.out, "");
      for (const std::string& part : told)
        EXPECT_TRUE(contains(outcome.err, part)) << part << "\n" << outcome.err;
    }
  }
  DiagramFolder folder;
};

TEST_F(Plugin, ABlockOfOnesOwnRuns) {
  const std::string own = libraries + "plugin_own.so";
  const Outcome outcome = run({"run", "d.json", "--blocks", own, "--blocks", own, "-q", "-o", "-"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "\n1,21,42\n")) << outcome.out;
  EXPECT_EQ(run({"sweep", "s.json", "-o", "r", "--blocks", own}).code, 0);
  const Outcome merged = run({"sweep", "--blocks", own, "merge", "r"});
  EXPECT_EQ(merged.code, 0) << merged.err;
}

TEST_F(Plugin, ANameThatIsTakenNamesBothSources) {
  is_refused(libraries + "plugin_taken.so", {"two blocks are called \"QuadraticDrag\"", "built in",
                                             "blocks/mechanics/quadratic_drag.cpp", "plugin_taken.so"});
}

TEST_F(Plugin, TwoLibrariesWithOneNameNameBoth) {
  std::filesystem::copy_file(libraries + "plugin_own.so", folder.path("copy.so"));
  const Outcome outcome =
      run({"check", "d.json", "--blocks", libraries + "plugin_own.so", "--blocks", "copy.so"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(contains(outcome.err, "\"Doubled\"") && contains(outcome.err, "plugin_own.so") &&
              contains(outcome.err, "copy.so"))
      << outcome.err;
}

TEST_F(Plugin, WhatCannotBeLoadedIsAnInputError) {
  folder.with("text.so", "no library");
  is_refused("text.so", {"\"text.so\" cannot be loaded"});
  is_refused("missing.so", {"\"missing.so\" cannot be loaded"});
  is_refused(".", {"cannot be loaded"});
}

TEST_F(Plugin, ALibraryWithoutBlocksOrOfOtherHeadersIsRefused) {
  is_refused(libraries + "plugin_empty.so", {"cannot be loaded", "no block"});
  is_refused(libraries + "plugin_older.so", {"cannot be loaded", "another version"});
}

}  // namespace
}  // namespace loopwright::plugin_test
