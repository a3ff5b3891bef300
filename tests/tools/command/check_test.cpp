// check recognizes every kind of file by its keys, and reports all its errors.
#include <gtest/gtest.h>
#include "tests/tools/command/program.h"

namespace loopwright::check_test {
namespace {

const std::string root = LOOPWRIGHT_SOURCE;

class Check : public ::testing::Test {
 protected:
  void SetUp() override {
    if (access(program().c_str(), X_OK) != 0) GTEST_SKIP() << program() << " is not built";
  }
  Outcome run(std::vector<std::string> arguments) const {
    return loopwright_program(std::move(arguments), folder.path(""));
  }
  DiagramFolder folder;
};

TEST_F(Check, NamesAChangedReadingOnceAndARunDoesNot) {
  folder.with("d.json",
              R"({"loopwright": 1, "solver": {"stop": 1, "step": 0.01}, "blocks": {"t": {"type": "Clock"},
    "low": {"type": "LowPass", "cutoff": {"value": 2, "unit": "Hz"}, "in": {"u": "t.time"}}}})");
  const std::string words = "earlier versions read";
  const Outcome checked = run({"check", "d.json"});
  EXPECT_EQ(checked.code, 0);
  ASSERT_NE(checked.err.find(words), checked.err.npos) << checked.err;
  EXPECT_EQ(checked.err.find(words), checked.err.rfind(words)) << checked.err;
  const Outcome ran = run({"run", "d.json", "-o", "r.csv"});
  EXPECT_EQ(ran.code, 0);
  EXPECT_EQ((ran.out + ran.err).find(words), ran.out.npos) << ran.err;
}

TEST_F(Check, RecordingsInMillimetresAndMicrometresAreCompared) {
  folder.with("a.csv", "time [s],x [mm]\n0,0\n1,1\n2,2\n");
  folder.with("b.csv", "time [ms],x [um]\n0,0\n1000,1000\n2000,2500\n");
  ASSERT_EQ(run({"report", "a.csv", "b.csv", "-o", "p.html"}).code, 0);
  const std::string page = text_of(folder.path("p.html"));
  EXPECT_EQ(page.find("Not compared"), page.npos);
  EXPECT_NE(page.find("Difference of x"), page.npos);
  EXPECT_NE(page.find("[0,0,0.5]"), page.npos) << "in the unit of the first";
}

TEST_F(Check, EveryKindOfFileIsToldByItsKeys) {
  folder.with("data.csv", "t,x\n0,0\n1,1\n2,2\n");
  folder.with(
      "e.json",
      R"({"loopwright": 1, "$schema": "x", "data": "data.csv", "compare": {"a.y": {"column": "x", "unit": "m"}}})");
  folder.with(
      "d.json",
      R"({"loopwright": 1, "$schema": "x", "solver": {"stop": 1}, "blocks": {"c": {"type": "Constant", "value": 1}}})");
  folder.with(
      "s.json",
      R"({"loopwright": 1, "$schema": "x", "diagram": "d.json", "axes": {"c.value": {"values": [1, 2]}},
    "metrics": {"end": {"final": "c.y"}}})");
  const std::string motor = root + "/diagrams/linear_motor/";
  for (const auto& [file, kind] : std::vector<std::pair<std::string, std::string>>{
           {"d.json", "1 blocks"},
           {"e.json", "an experiment of 3 rows, 0 driven and 1 compared"},
           {"s.json", "a sweep of 2 runs over 1 axes"},
           {root + "/diagrams/effects/cogging.json", "an effect"},
           {root + "/hw/devices/qpid_e.json", "a device of the driver quanser"},
           {motor + "ps.model.json", "a learned model of 13181 samples"},
           {motor + "stage.json", "a subdiagram of"}}) {
    const Outcome outcome = run({"check", file});
    EXPECT_EQ(outcome.code, 0) << file << outcome.err;
    EXPECT_TRUE(contains(outcome.out, file + ": fine, " + kind)) << outcome.out;
  }
}

TEST_F(Check, LooksAtTheBlocksOfAnEffect) {
  const char* effect = R"({"loopwright": 1, "effect": "e", "title": "x", "physics": "y", "parameters": {},
    "blocks": {"g": {"type": "Gian", "gain": 1, "in": {"u": "position"}}}, "attach": [{"to": "sensor", "from": "g.y"}],
    "needs": {"text": ""}})";
  folder.with("e.json", effect);
  const Outcome outcome = run({"check", "e.json"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(contains(outcome.err, "did you mean \"Gain\"?")) << outcome.err;
}

TEST_F(Check, EachKindIsHeldToItsOwnRules) {
  folder.with("e.json",
              R"({"loopwright": 1, "data": "none.csv", "comparre": {}, "drive": {"a.u": {"colum": "x"}}})");
  folder.with(
      "s.json",
      R"({"loopwright": 1, "diagram": "d.json", "axes": {"c.value": {"valus": [1]}}, "metrics": {}})");
  folder.with("t.json", R"({"loopwright": 1, "recordings": ["none.csv"], "labell": {}})");
  folder.with("device.json", R"({"loopwright": 1, "driver": "quansar"})");
  folder.with("effect.json",
              R"({"loopwright": 1, "effect": "effect", "title": "x", "blocks": {}, "atach": []})");
  folder.with("model.json", R"({"loopwright_gp_model": 1, "checksum": "0"})");
  for (const auto& [file, told] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"e.json",
            {"an experiment has no key \"comparre\"", "\"compare\"", "did you mean \"column\"?", "none.csv"}},
           {"s.json", {"did you mean \"values\"?"}},
           {"t.json", {"\"labell\"", "did you mean \"label\"?"}},
           {"device.json", {"did you mean \"quanser\"?"}},
           {"effect.json", {"did you mean \"attach\"?", "\"physics\""}},
           {"model.json", {"model.json:1:"}}}) {
    const Outcome outcome = run({"check", file});
    EXPECT_EQ(outcome.code, 2) << file << outcome.out;
    EXPECT_EQ(outcome.out, "");
    for (const std::string& part : told)
      EXPECT_TRUE(contains(outcome.err, part)) << part << "\n" << outcome.err;
  }
}

TEST_F(Check, ASweepsDiagramIsReadEvenWhereTheSweepIsWrong) {
  folder.with(
      "d.json",
      R"({"loopwright": 1, "solver": {"stop": 1}, "blocks": {"c": {"type": "Constnat", "value": 1}}})");
  folder.with("s.json", R"({"loopwright": 1, "diagram": "d.json", "axes": {"c.value": {"values": [1]}},
    "metrics": {"end": {"finale": "c.y"}}})");
  const Outcome outcome = run({"check", "s.json"});
  EXPECT_EQ(outcome.code, 2);
  for (const char* part : {"s.json:2:", "the metric measures nothing", "did you mean \"final\"?",
                           "d.json:1:", "did you mean \"Constant\"?"})
    EXPECT_TRUE(contains(outcome.err, part)) << part << "\n" << outcome.err;
}

TEST_F(Check, AllFormulasThatCannotBeReadAreTold) {
  folder.with("two.json", R"json({"loopwright": 1, "solver": {"stop": 1}, "blocks": {
  "a": {"type": "Expression", "formula": "2*(", "names": [], "in": {"arguments": []}},
  "b": {"type": "Expression", "formula": "3*)", "names": [], "in": {"arguments": []}}}})json");
  const Outcome outcome = run({"check", "two.json"});
  EXPECT_TRUE(contains(outcome.err, "block: a") && contains(outcome.err, "block: b")) << outcome.err;
}

TEST_F(Check, OptionsThatChangeNothingAreRefused) {
  const Outcome outcome =
      run({"check", root + "/hw/devices/qpid_e.json", "--set", "x=1", "--variant", "a=b"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(contains(outcome.err, "--set changes nothing in") &&
              contains(outcome.err, "--variant changes nothing in"))
      << outcome.err;
}

/// All files of a folder are checked at once: an option needs one that takes it.
TEST_F(Check, AnOptionForTheDiagramIsNoErrorInTheOtherFiles) {
  const std::string servo = root + "/diagrams/projects/servo/";
  const Outcome outcome =
      run({"check", "--strict-units", root + "/hw/devices/qpid_e.json", servo + "machine.json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(run({"check", "--strict-units", root + "/hw/devices/qpid_e.json"}).code, 2);
}

}  // namespace
}  // namespace loopwright::check_test
