// --set and drives: changes that the caller makes to a diagram.
#include <gtest/gtest.h>
#include "engine/json/json.h"
#include "tests/engine/diagram/diagram_folder.h"

namespace loopwright::override_test {
namespace {

class Overrides : public testing::Test {
 protected:
  Overrides() {
    folder_
        .with("top.json", R"({
  "loopwright": 1,
  "parameters": {"cutoff": {"value": 10, "unit": "rad/s"}, "twice": "=2*cutoff", "limit": {"value": 20, "unit": "1/s"}, "gains": [1, 2, 3], "offset": {"value": 1, "unit": "mm"}},
  "solver": {"step": 1e-3, "stop": 1},
  "inputs": {"force": "N"},
  "blocks": {
    "cogging": {"type": "CoggingForce", "harmonics": [{"amplitude": 1, "order": 1}, {"amplitude": 2}], "sample_time": 0.01},
    "filter": {"type": "LowPass", "cutoff": "=twice", "in": {"u": "force"}},
    "sum": {"type": "Sum", "in": {"terms": ["cogging.force", "filter.y", "force"]}},
    "stage": {"diagram": "stage.json", "in": {"command": "sum.sum"}}
  },
  "log": ["force", "stage.position"]
})")
        .with("stage.json", R"({
  "loopwright": 1,
  "parameters": {"payload": {"value": 0, "unit": "g"}, "name": "short"},
  "inputs": {"command": "N"}, "outputs": {"position": "axis.position"},
  "blocks": {"axis": {"diagram": "axis.json", "in": {"force": "command"}}}
})")
        .with("axis.json", R"({
  "loopwright": 1,
  "parameters": {"mass": {"value": 2, "unit": "kg"}},
  "inputs": {"force": "N"}, "outputs": {"position": "mass.position"},
  "blocks": {"mass": {"type": "Mass", "mass": "=mass", "in": {"force": "force"}}}
})");
  }

  std::shared_ptr<const Diagram> set(std::vector<std::pair<std::string, std::string>> settings) {
    LoadOptions options;
    options.set = std::move(settings);
    return folder_.load("top.json", options);
  }
  std::string problems_of_set(const std::string& path, const std::string& value) {
    LoadOptions options;
    options.set = {{path, value}};
    return folder_.problems("top.json", options);
  }
  static Drive drive(std::string port) {
    Problems problems;
    return {
        std::move(port),
        parse_json(std::make_shared<SourceFile>(SourceFile{"e.json", R"({"file": "d.csv", "column": "F"})"}),
                   problems)};
  }
  std::shared_ptr<const Diagram> driven(std::vector<std::string> ports) {
    LoadOptions options;
    for (auto& port : ports) options.drives.push_back(drive(port));
    return folder_.load("top.json", options);
  }
  std::string problems_of_drive(const std::string& port) {
    LoadOptions options;
    options.drives.push_back(drive(port));
    return folder_.problems("top.json", options);
  }

  static const Diagram& inside(const Diagram& diagram, std::string_view block) {
    return *block_of(diagram, block).subdiagram;
  }

  DiagramFolder folder_;
};

TEST_F(Overrides, SetAParameterAndAllThatFollowsFromIt) {
  const auto diagram = set({{"cutoff", "30"}});
  EXPECT_EQ(setting_of(*diagram, "filter", "cutoff").number, 60);
}

TEST_F(Overrides, SetAParameterByAnExpressionOfItsOwnDiagram) {
  EXPECT_DOUBLE_EQ(parameter_of(*set({{"cutoff", "=limit/4"}}), "twice").value.number, 10);
}

TEST_F(Overrides, SetTakesUnits) {
  EXPECT_DOUBLE_EQ(parameter_of(*set({{"offset", "25"}}), "offset").value.number, 0.025);
  EXPECT_DOUBLE_EQ(parameter_of(*set({{"offset", "25 m"}}), "offset").value.number, 25);
  EXPECT_DOUBLE_EQ(
      parameter_of(*set({{"offset", "{\"value\": 3, \"unit\": \"um\"}"}}), "offset").value.number, 3e-6);
  EXPECT_DOUBLE_EQ(parameter_of(inside(*set({{"stage.payload", "250"}}), "stage"), "payload").value.number,
                   0.25);
}

TEST_F(Overrides, ABareNumberKeepsTheUnitOfTheSetting) {
  folder_.with("top.json", R"({"loopwright": 1, "solver": {"stop": {"value": 500, "unit": "ms"}},
    "blocks": {"push": {"type": "Constant", "value": {"value": 1, "unit": "N"}},
               "m": {"type": "Mass", "mass": {"value": 500, "unit": "g"}, "in": {"force": "push.y"}}}})");
  const auto mass = [&](const std::string& text) {
    return set({{"m.mass", text}})->blocks.at(1).settings.find("mass")->value.number;
  };
  EXPECT_DOUBLE_EQ(mass("250"), 0.25);
  EXPECT_DOUBLE_EQ(mass("250 kg"), 250);
  EXPECT_DOUBLE_EQ(mass(R"({"value": 2, "unit": "t"})"), 2000);
  EXPECT_DOUBLE_EQ(set({{"solver.stop", "200"}})->solver.stop.value, 0.2);
  EXPECT_DOUBLE_EQ(set({{"solver.stop", "2 s"}})->solver.stop.value, 2);
}

TEST_F(Overrides, SetAnElementOfAListParameter) {
  const auto diagram = set({{"gains.1", "20"}});
  EXPECT_EQ(parameter_of(*diagram, "gains").value.items[1].number, 20);
  EXPECT_EQ(parameter_of(*diagram, "gains").value.items[2].number, 3);
}

TEST_F(Overrides, SetChangesWhatAnEarlierSetGave) {
  const auto diagram = set({{"gains", "[7, 8]"}, {"gains.1", "9"}});
  EXPECT_EQ(to_json(parameter_of(*diagram, "gains").value), "[7,9]");
}

TEST_F(Overrides, SetASettingDeepInABlock) {
  const auto diagram = set(
      {{"cogging.harmonics.0.amplitude", "7.5"}, {"cogging.sample_time", "0.02"}, {"cogging.extra", "word"}});
  const Value& harmonics = setting_of(*diagram, "cogging", "harmonics");
  EXPECT_EQ(harmonics.items[0].find("amplitude")->value.number, 7.5);
  EXPECT_EQ(harmonics.items[0].find("order")->value.number, 1);
  EXPECT_EQ(harmonics.items[1].find("amplitude")->value.number, 2);
  EXPECT_EQ(block_of(*diagram, "cogging").sample_time->number, 0.02);
  EXPECT_EQ(setting_of(*diagram, "cogging", "extra").text, "word");
}

TEST_F(Overrides, SetInsideSubdiagrams) {
  const auto diagram = set({{"stage.axis.mass", "5"}});
  const Diagram& axis = inside(inside(*diagram, "stage"), "axis");
  EXPECT_EQ(setting_of(axis, "mass", "mass").number, 5);
  const auto direct = set({{"stage.axis.mass.mass", "6"}});
  EXPECT_EQ(setting_of(inside(inside(*direct, "stage"), "axis"), "mass", "mass").number, 6);
  EXPECT_EQ(parameter_of(inside(inside(*direct, "stage"), "axis"), "mass").value.number, 2);
}

TEST_F(Overrides, SetASubdiagramParameterByAnExpressionOutside) {
  EXPECT_EQ(folder_.problems("top.json", {.set = {{"stage.name", "=cutoff"}}, .variants = {}, .drives = {}}),
            "--set stage.name:1:1: error: the parameter \"name\" is of the wrong kind\n  block: stage\n  "
            "expected: a text\n"
            "  found: the number 10\n1 error");
}

TEST_F(Overrides, SetTheSolver) {
  const auto diagram = set({{"solver.stop", "2.5"}, {"solver.method", "euler"}});
  EXPECT_EQ(diagram->solver.stop.value, 2.5);
  EXPECT_EQ(diagram->solver.method.value, "euler");
  EXPECT_EQ(diagram->solver.step.value, 1e-3);
}

TEST_F(Overrides, SetOfUnknownNamesIsAProblem) {
  EXPECT_EQ(problems_of_set("cutof", "1"),
            "--set cutof:1:1: error: there is no parameter or block \"cutof\"\n  hint: did you mean "
            "\"cutoff\"?\n1 error");
  EXPECT_EQ(problems_of_set("stage.payloat", "1"),
            "--set stage.payloat:1:1: error: there is no parameter or block \"payloat\"\n  block: stage\n"
            "  hint: did you mean \"payload\"?\n1 error");
  EXPECT_EQ(problems_of_set("solver.stopp", "1"),
            "--set solver.stopp:1:1: error: the solver has no key \"stopp\"\n  hint: did you mean "
            "\"stop\"?\n1 error");
  EXPECT_EQ(problems_of_set("cogging.harmonics.2.amplitude", "1"),
            "--set cogging.harmonics.2.amplitude:1:1: error: \"cogging.harmonics.2.amplitude\" cannot be "
            "set\n  block: cogging\n"
            "  expected: an index from 0 to 1\n  found: 2\n1 error");
}

TEST_F(Overrides, SetOfWhatIsNoSettingIsAProblem) {
  for (const auto* path : {"stage", "cogging", "cogging.type", "cogging.in", "stage.axis", "solver",
                           "cogging.sample_time.x", "filter.in.u"})
    EXPECT_NE(problems_of_set(path, "1"), "") << path;
  for (const auto* path : {"", ".", "a..b", "a b", "µ", "cutoff.", "gains.x", "gains.3"})
    EXPECT_NE(problems_of_set(path, "1"), "") << path;
}

TEST_F(Overrides, SetOfAWrongUnitOrKindIsAProblem) {
  EXPECT_EQ(problems_of_set("offset", "3 kg"),
            "--set offset:1:1: error: the unit does not fit the parameter \"offset\"\n  expected: mm\n  "
            "found: kg\n1 error");
  EXPECT_EQ(problems_of_set("offset", "much"),
            "--set offset:1:1: error: the parameter \"offset\" is of the wrong kind\n  expected: a number\n  "
            "found: the text \"much\"\n1 error");
  EXPECT_EQ(problems_of_set("gains", "[1,"),
            "--set gains:1:4: error: the file ends too early\n  at: /1\n  expected: \"]\" for the \"[\" in "
            "line 1\n1 error");
}

TEST_F(Overrides, DriveReplacesAWire) {
  const auto diagram = driven({"filter.u"});
  const BlockEntry& column = diagram->blocks.back();
  EXPECT_EQ(column.name, "recorded_filter_u");
  EXPECT_EQ(column.type, "RecordedColumn");
  EXPECT_EQ(column.settings.find("column")->value.text, "F");
  EXPECT_EQ(source_of(block_of(*diagram, "filter"), "u"), "recorded_filter_u.value");
  EXPECT_EQ(block_of(*diagram, "filter").in.size(), 1u);
}

TEST_F(Overrides, DriveFeedsAPortThatHadNoWire) {
  EXPECT_EQ(source_of(block_of(*driven({"cogging.position"}), "cogging"), "position"),
            "recorded_cogging_position.value");
}

TEST_F(Overrides, DriveReplacesOneWireOfAListOrAddsOne) {
  const auto diagram = driven({"sum.terms[1]", "sum.terms[3]"});
  const BlockEntry& sum = block_of(*diagram, "sum");
  ASSERT_EQ(sum.in[0].wires.size(), 4u);
  EXPECT_EQ(source_of(sum, "terms", 0), "cogging.force");
  EXPECT_EQ(source_of(sum, "terms", 1), "recorded_sum_terms_1_.value");
  EXPECT_EQ(source_of(sum, "terms", 3), "recorded_sum_terms_3_.value");
}

TEST_F(Overrides, DriveReachesInputsOfSubdiagrams) {
  EXPECT_EQ(source_of(block_of(*driven({"stage.command"}), "stage"), "command"),
            "recorded_stage_command.value");
}

TEST_F(Overrides, DriveReachesNestedBlocks) {
  const auto diagram = driven({"stage.axis.mass.force"});
  const BlockEntry& stage = block_of(*diagram, "stage");
  EXPECT_EQ(source_of(stage, "recorded_stage_axis_mass_force"), "recorded_stage_axis_mass_force.value");
  const BlockEntry& axis = block_of(*stage.subdiagram, "axis");
  EXPECT_EQ(stage.subdiagram->inputs.back().name, "recorded_stage_axis_mass_force");
  EXPECT_EQ(source_of(axis, "recorded_stage_axis_mass_force"), "recorded_stage_axis_mass_force");
  EXPECT_EQ(source_of(block_of(*axis.subdiagram, "mass"), "force"), "recorded_stage_axis_mass_force");
}

TEST_F(Overrides, DriveTakesThePlaceOfAnInputOfTheDiagram) {
  const auto diagram = driven({"force"});
  EXPECT_TRUE(diagram->inputs.empty());
  EXPECT_EQ(source_of(block_of(*diagram, "filter"), "u"), "recorded_force.value");
  EXPECT_EQ(source_of(block_of(*diagram, "sum"), "terms", 2), "recorded_force.value");
  EXPECT_EQ(diagram->log[0].source, "recorded_force.value");
}

TEST_F(Overrides, SeveralDrivesDoNotDisturbEachOther) {
  const auto diagram = driven({"stage.axis.force", "stage.command", "stage.axis.mass.force"});
  EXPECT_EQ(diagram->blocks.size(), 7u);
  EXPECT_EQ(source_of(block_of(inside(*diagram, "stage"), "axis"), "force"), "recorded_stage_axis_force");
}

TEST_F(Overrides, DriveOfWhatIsNotThereIsAProblem) {
  EXPECT_EQ(
      problems_of_drive("stag.command"),
      "e.json:1:1: error: there is no block \"stag\" to drive\n  hint: did you mean \"stage\"?\n1 error");
  EXPECT_EQ(problems_of_drive("stage.comand"),
            "e.json:1:1: error: the subdiagram has no input \"comand\"\n  block: stage\n  hint: did you mean "
            "\"command\"?\n1 error");
  EXPECT_EQ(problems_of_drive("forze"),
            "e.json:1:1: error: the diagram has no input \"forze\" to drive\n  hint: did you mean "
            "\"force\"?\n1 error");
  EXPECT_EQ(
      problems_of_drive("filter.u.x"),
      "e.json:1:1: error: \"filter\" is not a subdiagram\n  block: filter\n  found: filter.u.x\n1 error");
  EXPECT_NE(problems_of_drive("sum.terms[9]").find("has no wire 9"), std::string::npos);
  for (const auto* port : {"", ".", "a.", "sum.terms[", "sum.terms[x]", "sum.terms[-1]"})
    EXPECT_NE(problems_of_drive(port), "") << port;
}

}  // namespace
}  // namespace loopwright::override_test
