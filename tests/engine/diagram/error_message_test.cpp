// The exact messages for errors in a diagram, one kind of error at a time.
#include <gtest/gtest.h>
#include "tests/engine/diagram/diagram_folder.h"

namespace loopwright::error_message_test {
namespace {

std::string problems_in(std::string_view text) { return DiagramFolder().with("top.json", text).problems(); }

/// The problems of a diagram with these members besides its version.
std::string problems_with(const std::string& members) {
  return problems_in("{\"loopwright\": 1,\n" + members + "}");
}

struct Golden {
  std::string members, problems;
};

void expect(const std::vector<Golden>& cases) {
  for (const Golden& golden : cases)
    EXPECT_EQ(problems_with(golden.members), golden.problems) << golden.members;
}

TEST(DiagramErrors, TopOfTheFile) {
  EXPECT_EQ(problems_in("[]"),
            "top.json:1:1: error: the diagram is of the wrong kind\n  expected: an object: { \"loopwright\": "
            "1, … }\n"
            "  found: an empty list\n1 error");
  EXPECT_EQ(problems_in("{}"),
            "top.json:1:1: error: the key \"loopwright\" is missing: the version of the format\n  expected: "
            "\"loopwright\": 1\n1 error");
  EXPECT_EQ(problems_in("{\"loopwright\": 2}"),
            "top.json:1:16: error: the version of the format is not known\n  at: /loopwright\n  expected: "
            "\"loopwright\": 1\n"
            "  found: the number 2\n  hint: a newer Loopwright wrote this file\n1 error");
  EXPECT_EQ(problems_in("{\"loopwright\": 0.5}"),
            "top.json:1:16: error: the version of the format is not known\n  at: /loopwright\n  expected: "
            "\"loopwright\": 1\n"
            "  found: the number 0.5\n1 error");
  EXPECT_EQ(problems_with("\"block\": {}"),
            "top.json:2:1: error: a diagram has no key \"block\"\n  at: /block\n  hint: did you mean "
            "\"blocks\"?\n1 error");
  EXPECT_EQ(problems_with("\"title\": 3"),
            "top.json:2:10: error: \"title\" is of the wrong kind\n  at: /title\n  expected: a text in "
            "quotes\n  found: the number 3\n1 error");
}

TEST(DiagramErrors, AMisspeltFileIsRecognizedAmongThoseOfItsFolder) {
  DiagramFolder folder;
  folder.with("sub/stage.json", "{}").with("sub/stage.csv", "").with("sub/stag_e.experiment.json", "{}");
  folder.with("top.json", "{\"loopwright\": 1, \"blocks\": {\n\"a\": {\"diagram\": \"sub/stge.json\"}}}");
  EXPECT_THAT(folder.problems(), testing::HasSubstr("hint: did you mean \"sub/stage.json\"?"));
  EXPECT_THAT(folder.problems("sub/loop.json"), testing::Not(testing::HasSubstr("hint")));
}

TEST(DiagramErrors, Files) {
  DiagramFolder folder;
  EXPECT_EQ(folder.problems("none.json"),
            "none.json:1:1: error: the file \"none.json\" cannot be read: there is no such file\n1 error");
  folder
      .with("top.json",
            "{\"loopwright\": 1, \"blocks\": {\n\"a\": {\"diagram\": \"sub/none.json\"},\n\"b\": "
            "{\"diagram\": \"sub\"},\n\"c\": {\"diagram\": \"\"}}}")
      .with("sub/x.json", "{}");
  EXPECT_EQ(folder.problems(),
            "top.json:2:18: error: the file \"sub/none.json\" cannot be read: there is no such file\n"
            "top.json:3:18: error: the file \"sub\" cannot be read: it is a folder\n"
            "top.json:4:18: error: the path of the diagram is empty\n  block: c\n  at: /blocks/c/diagram\n3 "
            "errors");
}

TEST(DiagramErrors, ADiagramThatContainsItself) {
  DiagramFolder folder;
  folder.with("top.json", R"({"loopwright": 1, "blocks": {"a": {"diagram": "x/b.json"}}})")
      .with("x/b.json", R"({"loopwright": 1, "blocks": {"c": {"diagram": "../top.json"}}})");
  EXPECT_EQ(folder.problems(),
            "x/b.json:1:47: error: a diagram contains itself\n  block: a.c\n  at: /blocks/c/diagram\n"
            "  found: top.json → x/b.json → top.json\n1 error");
}

TEST(DiagramErrors, Parameters) {
  expect({
      {R"("parameters": {"a": {"value": 1, "unti": "m"}})",
       "top.json:2:34: error: a parameter has no key \"unti\"\n  at: /parameters/a/unti\n  hint: did you "
       "mean \"unit\"?\n1 error"},
      {R"("parameters": {"a": {"unit": "m"}})",
       "top.json:2:16: error: the parameter \"a\" has no \"value\"\n  at: /parameters/a\n1 error"},
      {R"("parameters": {"a": {"value": 1, "unit": "Nm"}})",
       "top.json:2:42: error: there is no unit \"Nm\"\n  at: /parameters/a/unit\n"
       "  expected: an SI unit such as \"N*m\", \"V*s^2/m\", \"mm\", \"rad/s\", or \"1\"\n"
       "  hint: did you mean \"N*m\"?\n1 error"},
      {R"("parameters": {"2a": 1, "pi": 3, "a.b": 1})",
       "top.json:2:16: error: \"2a\" cannot be the name of a parameter\n  at: /parameters/2a\n"
       "  expected: letters, digits and underscores, not starting with a digit\n"
       "top.json:2:25: error: \"pi\" cannot be the name of a parameter: it is a constant\n  at: "
       "/parameters/pi\n"
       "top.json:2:34: error: \"a.b\" cannot be the name of a parameter\n  at: /parameters/a.b\n"
       "  expected: letters, digits and underscores, not starting with a digit\n3 errors"},
      {R"("parameters": {"mass": 1, "a": "=2*mas"})",
       "top.json:2:36: error: there is no parameter \"mas\"\n  at: /parameters/a\n  hint: did you mean "
       "\"mass\"?\n1 error"},
      {R"("parameters": {"a": "=b+1", "b": "=2*c", "c": "=a", "d": "=a"})",
       "top.json:2:16: error: parameters depend on each other in a cycle\n  at: /parameters/a\n  found: a → "
       "b "
       "→ c → a\n1 error"},
      {R"("parameters": {"a": "=a"})",
       "top.json:2:16: error: parameters depend on each other in a cycle\n  at: /parameters/a\n  found: a → "
       "a\n1 error"},
      {R"("parameters": {"m": {"value": 1, "unit": "kg"}, "a": {"value": "=2*m", "unit": "N"}})",
       "top.json:2:64: error: the unit does not fit the parameter \"a\"\n  at: /parameters/a/value\n  "
       "expected: N\n  found: kg from =2*m\n1 error"},
      {R"("parameters": {"a": null, "b": [[], null], "c": {"value": {"x": 1}}})",
       "top.json:2:21: error: the parameter \"a\" is of the wrong kind\n  at: /parameters/a\n"
       "  expected: a number, a text, true, false, or a list of them\n  found: null\n"
       "top.json:2:37: error: the parameter \"b\" is of the wrong kind\n  at: /parameters/b/1\n"
       "  expected: a number, a text, true, false, or a list of them\n  found: null\n"
       "top.json:2:59: error: the parameter \"c\" is of the wrong kind\n  at: /parameters/c/value\n"
       "  expected: a number, a text, true, false, or a list of them\n  found: an object\n3 errors"},
      {R"("parameters": {"a": "word", "b": "=2*a"})",
       "top.json:2:38: error: the parameter \"a\" is not a number\n  at: /parameters/b\n  found: the text "
       "\"word\"\n1 error"},
  });
}

TEST(DiagramErrors, OneBrokenParameterIsToldOnce) {
  EXPECT_EQ(
      problems_with(
          R"("parameters": {"a": "=1/0", "b": "=2*a", "c": "=b"}, "blocks": {"x": {"type": "T", "k": "=c"}})"),
      "top.json:2:23: error: the result of the expression is not a finite number\n  at: /parameters/a\n"
      "  found: =1/0, which is inf\n1 error");
}

TEST(DiagramErrors, Solver) {
  expect({
      {R"("solver": {"method": "rk5"})",
       "top.json:2:22: error: there is no solver method \"rk5\"\n  at: /solver/method\n"
       "  expected: one of euler, heun, rk4, dopri5, cvode-bdf, cvode-adams\n  hint: did you mean "
       "\"rk4\"?\n1 error"},
      {R"("solver": {"step": 0, "stpo": 3})",
       "top.json:2:20: error: \"step\" is out of range\n  at: /solver/step\n  expected: a number above 0\n  "
       "found: the number 0\n"
       "top.json:2:23: error: the solver has no key \"stpo\"\n  at: /solver/stpo\n  hint: did you mean "
       "\"stop\"?\n2 errors"},
      {R"("parameters": {"l": {"value": 1, "unit": "m"}}, "solver": {"stop": "=2*l"})",
       "top.json:2:68: error: the unit does not fit \"stop\"\n  at: /solver/stop\n  expected: s\n  found: m "
       "from =2*l\n1 error"},
      {R"("solver": {"start": 2, "stop": 1})",
       "top.json:2:32: error: the run stops before it starts\n  at: /solver/stop\n  expected: at least 2 s\n "
       " found: 1 s\n1 error"},
      {R"("solver": {"seed": 1.5})",
       "top.json:2:20: error: \"seed\" is out of range\n  at: /solver/seed\n  expected: a whole number from "
       "0 to 2^53\n  found: the number 1.5\n1 error"},
      {R"("solver": {"stop": "1"})",
       "top.json:2:20: error: \"stop\" is of the wrong kind\n  at: /solver/stop\n  expected: a number in s\n "
       " found: the text \"1\"\n  hint: a number stands without quotes; an expression starts with '=', as "
       "in \"=2*pi*40\"\n1 error"},
      {R"("solver": {"step": "0.5 ms"})",
       "top.json:2:20: error: \"step\" is of the wrong kind\n  at: /solver/step\n  expected: a number in s\n "
       " found: the text \"0.5 ms\"\n  hint: a number with a unit is written {\"value\": 0.5, \"unit\": "
       "\"ms\"}\n1 error"},
  });
}

TEST(DiagramErrors, Blocks) {
  expect({
      {R"("blocks": {"a": {"typ": "T"}})",
       "top.json:2:17: error: the block has neither \"type\" nor \"diagram\"\n  block: a\n  at: /blocks/a\n  "
       "hint: did you mean \"type\" for \"typ\"?\n1 error"},
      {R"("blocks": {"a": 3})",
       "top.json:2:17: error: a block is of the wrong kind\n  block: a\n  at: /blocks/a\n"
       "  expected: an object: {\"type\": …, \"in\": {…}}\n  found: the number 3\n1 error"},
      {R"("blocks": {"a b": {"type": "T"}})",
       "top.json:2:12: error: \"a b\" cannot be the name of a block\n  at: /blocks/a b\n"
       "  expected: letters, digits and underscores, not starting with a digit\n1 error"},
      {R"("blocks": {"a": {"type": "T", "parameters": {}}})",
       "top.json:2:31: error: only a subdiagram has \"parameters\"\n  block: a\n  at: /blocks/a/parameters\n"
       "  hint: settings of a block stand directly in its object\n1 error"},
      {R"("blocks": {"a": {"type": "T", "sample_time": -1}})",
       "top.json:2:46: error: \"sample_time\" is out of range\n  block: a\n  at: /blocks/a/sample_time\n  "
       "expected: a number above 0, in s\n"
       "  found: the number -1\n1 error"},
      {R"("blocks": {"a": {"type": "T", "k": [1, "=2*q"]}})",
       "top.json:2:44: error: there is no parameter \"q\"\n  block: a\n  at: /blocks/a/k/1\n"
       "  hint: an expression uses the \"parameters\" of its own diagram\n1 error"},
      {R"("blocks": {"a": {"type": "T", "variant": "x"}})",
       "top.json:2:31: error: \"variant\" chooses among \"variants\", which are missing\n  block: a\n  at: "
       "/blocks/a/variant\n1 error"},
  });
}

TEST(DiagramErrors, Wires) {
  expect({
      {R"("blocks": {"a": {"type": "T", "in": {"u": 3, "v": ["x.y", "x..y"], "w": {"from": "x.y"}}}})",
       "top.json:2:43: error: the wire of the input \"u\" is of the wrong kind\n  block: a\n  at: "
       "/blocks/a/in/u\n"
       "  expected: a port in quotes, as in \"stage.position\" or \"gain.y[2]\"\n  found: the number 3\n"
       "top.json:2:59: error: the wire of the input \"v\" does not name a port\n  block: a\n  at: "
       "/blocks/a/in/v/1\n"
       "  expected: a port in quotes, as in \"stage.position\" or \"gain.y[2]\"\n  found: the text \"x..y\"\n"
       "top.json:2:73: error: the wire of the input \"w\" is of the wrong kind\n  block: a\n  at: "
       "/blocks/a/in/w\n"
       "  expected: a port in quotes, as in \"stage.position\" or \"gain.y[2]\"\n  found: an object\n3 "
       "errors"},
      {R"("blocks": {"a": {"type": "T", "in": "x.y"}})",
       "top.json:2:37: error: \"in\" is of the wrong kind\n  block: a\n  at: /blocks/a/in\n"
       "  expected: an object: {\"input\": \"block.output\"}\n  found: the text \"x.y\"\n1 error"},
      {R"("log": "a.b")",
       "top.json:2:8: error: \"log\" is of the wrong kind\n  at: /log\n  expected: a list of ports\n  found: "
       "the text \"a.b\"\n1 error"},
      {R"("outputs": {"y": {"unit": "m"}, "z": "1x"}, "inputs": {"u": "Nm", "v": 1})",
       "top.json:2:13: error: the output \"y\" has no \"source\"\n  at: /outputs/y\n  expected: \"source\": "
       "\"block.output\"\n"
       "top.json:2:38: error: the source of the output \"z\" does not name a port\n  at: /outputs/z\n"
       "  expected: a port in quotes, as in \"stage.position\" or \"gain.y[2]\"\n  found: the text \"1x\"\n"
       "top.json:2:61: error: there is no unit \"Nm\"\n  at: /inputs/u\n"
       "  expected: an SI unit such as \"N*m\", \"V*s^2/m\", \"mm\", \"rad/s\", or \"1\"\n"
       "  hint: did you mean \"N*m\"?\n"
       "top.json:2:72: error: an input is of the wrong kind\n  at: /inputs/v\n"
       "  expected: its unit in quotes, or {\"unit\": …, \"description\": …}\n  found: the number 1\n4 "
       "errors"},
  });
}

TEST(DiagramErrors, Subdiagrams) {
  DiagramFolder folder;
  folder
      .with("stage.json",
            R"({"loopwright": 1, "parameters": {"payload": {"value": 0, "unit": "kg"}, "gain": 1}})")
      .with("top.json", R"({"loopwright": 1, "parameters": {"l": {"value": 1, "unit": "m"}}, "blocks": {
"a": {"diagram": "stage.json", "parameters": {"payloud": 1}},
"b": {"diagram": "stage.json", "parameters": {"payload": "=l"}},
"c": {"diagram": "stage.json", "parameters": {"gain": "=l"}},
"d": {"diagram": "stage.json", "parameters": {"gain": "much"}},
"e": {"diagram": "stage.json", "type": "T", "sample_time": 1, "payload": 3},
"f": {"diagram": 5}
}})");
  EXPECT_EQ(folder.problems(),
            "top.json:2:47: error: the diagram has no parameter \"payloud\"\n  block: a\n  at: "
            "/blocks/a/parameters/payloud\n  hint: did you mean \"payload\"?\n"
            "top.json:3:58: error: the unit does not fit the parameter \"payload\"\n  block: b\n  at: "
            "/blocks/b/parameters/payload\n  expected: kg\n  found: m from =l\n"
            "top.json:4:55: error: the unit does not fit the parameter \"gain\"\n  block: c\n  at: "
            "/blocks/c/parameters/gain\n"
            "  expected: a bare number, as the parameter has no unit\n  found: m from =l\n"
            "top.json:5:55: error: the parameter \"gain\" is of the wrong kind\n  block: d\n  at: "
            "/blocks/d/parameters/gain\n  expected: a number\n  found: the text \"much\"\n"
            "top.json:6:32: error: a subdiagram has no key \"type\"\n  block: e\n  at: /blocks/e/type\n"
            "  expected: one of diagram, parameters, in, description, enabled_by, triggered_by, edge, while_disabled\n  hint: an entry has either \"type\" "
            "or \"diagram\"\n"
            "top.json:6:45: error: a subdiagram has no key \"sample_time\"\n  block: e\n  at: "
            "/blocks/e/sample_time\n"
            "  expected: one of diagram, parameters, in, description, enabled_by, triggered_by, edge, while_disabled\n  hint: sample times belong to the "
            "blocks inside\n"
            "top.json:6:63: error: a subdiagram has no key \"payload\"\n  block: e\n  at: /blocks/e/payload\n"
            "  expected: one of diagram, parameters, in, description, enabled_by, triggered_by, edge, while_disabled\n  hint: parameters of the diagram "
            "stand in \"parameters\"\n"
            "top.json:7:18: error: \"diagram\" is of the wrong kind\n  block: f\n  at: /blocks/f/diagram\n"
            "  expected: the path of a diagram file in quotes, or a diagram in braces\n  found: the number "
            "5\n8 errors");
}

TEST(DiagramErrors, Variants) {
  LoadOptions options;
  options.variants = {
      {"stage", "qanser"}, {"plain", "x"}, {"nowhere", "x"}, {"plain.deep", "x"}, {"a..b", "x"}};
  DiagramFolder folder;
  folder.with("top.json", R"({"loopwright": 1, "blocks": {
"stage": {"variants": {"simulated": {"type": "M", "in": {}}, "quanser": {"device": "x"}}, "sample_time": 1},
"empty": {"variants": {}},
"wrong": {"variants": {"a": {"type": "T"}}, "variant": "b"},
"plain": {"type": "T"}
}})");
  EXPECT_EQ(
      folder.problems("top.json", options),
      "--variant a..b:1:1: error: \"a..b\" is no path of a block\n  expected: names with dots between them, "
      "as in axis.stage=quanser\n"
      "--variant nowhere:1:1: error: there is no block \"nowhere\"\n  expected: one of stage, empty, wrong, "
      "plain\n"
      "--variant plain:1:1: error: the block \"plain\" has no variants\n  block: plain\n"
      "--variant plain.deep:1:1: error: the block \"plain\" is not a subdiagram\n  block: plain\n"
      "--variant stage:1:1: error: the block has no variant \"qanser\"\n  block: stage\n  hint: did you mean "
      "\"quanser\"?\n"
      "top.json:2:51: error: a variant cannot have its own wires\n  block: stage\n  at: "
      "/blocks/stage/variants/simulated/in\n"
      "  hint: \"in\" stands beside \"variants\", for all of them\n"
      "top.json:2:62: error: the variant \"quanser\" has neither \"type\" nor \"diagram\"\n  block: stage\n  "
      "at: /blocks/stage/variants/quanser\n"
      "top.json:2:91: error: a block with variants has no key \"sample_time\"\n  block: stage\n  at: "
      "/blocks/stage/sample_time\n"
      "  expected: one of variants, variant, in, description\n"
      "top.json:3:23: error: there is no variant to choose\n  block: empty\n  at: /blocks/empty/variants\n"
      "top.json:4:56: error: the block has no variant \"b\"\n  block: wrong\n  at: /blocks/wrong/variant\n  "
      "expected: one of a\n10 errors");
}

TEST(DiagramErrors, OfAFileUsedManyTimesAreToldOnce) {
  DiagramFolder folder;
  folder.with("stage.json", R"({"loopwright": 1, "solver": {"stop": -1}, "blocks": {"b": {}}})")
      .with(
          "top.json",
          R"({"loopwright": 1, "blocks": {"a": {"diagram": "stage.json"}, "b": {"diagram": "stage.json"}}})");
  const std::string text = folder.problems();
  EXPECT_NE(text.find("2 errors"), std::string::npos) << text;
}

TEST(DiagramErrors, AFewFilesCannotNameEachOtherIntoBillionsOfBlocks) {
  DiagramFolder folder;
  for (int i = 0; i < 25; ++i) {
    const std::string next = "\"d" + std::to_string(i + 1) + ".json\"";
    std::string blocks;
    for (int b = 0; b < 30; ++b)
      blocks += (b > 0 ? ", \"b" : "\"b") + std::to_string(b) + "\": {\"diagram\": " + next + "}";
    folder.with("d" + std::to_string(i) + ".json", "{\"loopwright\": 1, \"blocks\": {" + blocks + "}}");
  }
  folder.with("d25.json", "{\"loopwright\": 1}");
  EXPECT_NE(folder.problems("d0.json").find("the diagram has more than 200000 blocks"), std::string::npos);
}

}  // namespace
}  // namespace loopwright::error_message_test
