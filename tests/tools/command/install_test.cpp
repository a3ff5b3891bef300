// The result of `cmake --install` works after it was moved: the program finds its lanes and its effects
// beside itself.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include "tests/tools/command/program.h"

namespace loopwright::install_test {
namespace {

namespace fs = std::filesystem;

int shell(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()); }

class Installed : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* needed : {"/bin/loopwright", "/bin/hidden_effects", "/lib/loopwright_lanes_avx2.so",
                               "/lib/libhil_emulator.so", "/lib/python/loopwright/__init__.py"})
      if (!fs::exists(LOOPWRIGHT_BINARY + std::string(needed))) GTEST_SKIP() << needed << " is not built";
    ASSERT_EQ(shell("cmake --install " LOOPWRIGHT_BINARY " --prefix " + folder.path("first")), 0);
    fs::rename(folder.path("first"), folder.path("moved"));
    unsetenv("LOOPWRIGHT_EFFECTS");
    setenv("LOOPWRIGHT_PROGRAM", folder.path("moved/bin/loopwright").c_str(), 1);
  }
  void TearDown() override { unsetenv("LOOPWRIGHT_PROGRAM"); }
  Outcome run(std::vector<std::string> arguments) const {
    return loopwright_program(std::move(arguments), folder.path("moved"));
  }
  DiagramFolder folder;
};

TEST_F(Installed, EveryCommandWorksFromWhereItWasMovedTo) {
  const std::string diagrams = "share/loopwright/diagrams/";
  EXPECT_EQ(run({"run", diagrams + "linear_motor/conventional.json", "--set", "solver.stop=0.1", "-q"}).code,
            0);
  EXPECT_EQ(run({"check", diagrams + "linear_motor/conventional.json", "--variant", "stage=quanser"}).code, 0)
      << "the device file lies where diagrams look for it";
  EXPECT_TRUE(contains(run({"blocks", "Mass"}).out, "Mass"));
  EXPECT_TRUE(contains(run({"schema"}).out, "$defs"));
  for (const char* kind : {"diagram", "experiment", "sweep", "training", "effect", "device", "model"})
    EXPECT_EQ(text_of(folder.path("moved/share/loopwright/schema/") + kind + ".schema.json"),
              run({"schema", kind}).out);
  EXPECT_TRUE(fs::exists(folder.path("moved/share/loopwright/docs/blocks.md")));
  EXPECT_TRUE(fs::exists(folder.path("moved/include/loopwright/engine/block.h")));
  const std::string job = folder.path("moved/") + diagrams + "linear_motor/common_job.json";
  EXPECT_EQ(shell("PYTHONPATH=$(echo " + folder.path("moved/lib/python3/dist-packages") +
                  ") /usr/bin/python3 -B -c \"import loopwright; loopwright.load('" + job + "').run()\""),
            0);
  folder.with("moved/loop.json", R"({"loopwright": 1, "solver": {"stop": 1, "step": 0.1}, "blocks": {
  "c": {"type": "Constant", "value": 1}, "x": {"type": "Integrator", "in": {"u": "c.y"}}}})");
  folder.with(
      "moved/s.json",
      R"({"loopwright": 1, "diagram": "loop.json", "axes": {"c.value": {"linear": {"from": 1, "to": 2, "count": 64}}},
  "metrics": {"end": {"final": "x.y"}}})");
  if (!__builtin_cpu_supports("avx2")) return;
  const Outcome sweep = run({"sweep", "s.json", "-o", "r", "--lanes", "avx2"});
  EXPECT_EQ(sweep.code, 0) << sweep.err;
}

TEST_F(Installed, TheCatalogueOfEffectsIsFound) {
  ASSERT_EQ(
      shell(LOOPWRIGHT_BINARY "/bin/hidden_effects 21 " + folder.path("hidden") + " paper coulomb_friction"),
      0);
  const Outcome outcome = run({"diagnose", folder.path("hidden/nominal.json"),
                               folder.path("hidden/train.experiment.json"), "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto effects = nlohmann::json::parse(outcome.out).at("effects");
  ASSERT_FALSE(effects.empty());
  EXPECT_EQ(effects[0]["effect"], "coulomb_friction");
}

TEST_F(Installed, NoPathOfTheSourcesIsNeeded) {
  const std::string program = text_of(folder.path("moved/bin/loopwright"));
  EXPECT_FALSE(contains(program, LOOPWRIGHT_SOURCE "/diagrams"));
  EXPECT_FALSE(contains(program, LOOPWRIGHT_BINARY "/lib"));
}

TEST_F(Installed, WithoutItsDataTheProgramSaysWhatIsMissing) {
  fs::remove_all(folder.path("moved/share"));
  ASSERT_EQ(
      shell(LOOPWRIGHT_BINARY "/bin/hidden_effects 21 " + folder.path("hidden") + " paper coulomb_friction"),
      0);
  const Outcome outcome =
      run({"diagnose", folder.path("hidden/nominal.json"), folder.path("hidden/train.experiment.json")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(contains(outcome.err, "share/loopwright/diagrams/effects") &&
              contains(outcome.err, "LOOPWRIGHT_EFFECTS"))
      << outcome.err;
}

}  // namespace
}  // namespace loopwright::install_test
