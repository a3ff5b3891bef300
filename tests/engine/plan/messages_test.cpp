// Misspelled, missing and superfluous members of a diagram are reported with source location and a suggested
// correction.
#include <gtest/gtest.h>
#include "tests/engine/written_diagram.h"

namespace loopwright::messages_test {
namespace {

TEST(Messages, AnUnknownTypeSaysWhatWasMeant) {
  EXPECT_EQ(problems_of(diagram(R"("a": {"type": "Integrater", "in": {"u": "a.y"}})")),
            R"(top.json:2:15: error: there is no block type "Integrater"
  block: a
  at: /blocks/a/type
  hint: did you mean "Integrator"?
1 error)");
}

TEST(Messages, AnUnknownTypeLikeNothingPointsToTheList) {
  EXPECT_TRUE(
      has(problems_of(diagram(R"("a": {"type": "Xyzzyplugh"})")), "`loopwright blocks` lists all types"));
}

TEST(Messages, AnUnknownInputSaysWhatWasMeantAndWhatThereIs) {
  const std::string text =
      problems_of(diagram(R"("m": {"type": "Mass", "mass": 1, "in": {"forse": "m.position"}})"));
  EXPECT_TRUE(has(text, "Mass has no input \"forse\"")) << text;
  EXPECT_TRUE(has(text, "did you mean \"force\"?")) << text;
  EXPECT_TRUE(has(text, "the input \"force\" is not wired")) << text;
}

TEST(Messages, AnUnknownOutputSaysWhatWasMeant) {
  const std::string text = problems_of(diagram(
      R"("m": {"type": "Mass", "mass": 1, "in": {"force": "f.force"}}, "f": {"type": "Spring", "stiffness": 1, "in": {"position": "m.postion"}})"));
  EXPECT_TRUE(has(text, "Mass \"m\" has no output \"postion\"")) << text;
  EXPECT_TRUE(has(text, "did you mean \"position\"?")) << text;
  EXPECT_TRUE(has(text, "/blocks/f/in/position")) << text;
}

TEST(Messages, AnUnknownBlockSaysWhatWasMeant) {
  const std::string text = problems_of(
      diagram(R"("stage": {"type": "Clock"}, "g": {"type": "Gain", "gain": 1, "in": {"u": "stgae.time"}})"));
  EXPECT_TRUE(has(text, "there is no block \"stgae\"") && has(text, "did you mean \"stage\"?")) << text;
}

TEST(Messages, AnUnknownParameterSaysWhatWasMeant) {
  const std::string text = problems_of(
      diagram(R"("m": {"type": "Mass", "mass": 1, "paylaod": 2, "in": {"force": "m.position"}})"));
  EXPECT_TRUE(has(text, "paylaod") && has(text, "did you mean \"payload\"?")) << text;
}

TEST(Messages, AMissingParameterAndAWrongRangeAreTold) {
  const std::string text = problems_of(diagram(
      R"("a": {"type": "Mass", "in": {"force": "c.y"}}, "b": {"type": "Mass", "mass": -1, "in": {"force": "c.y"}},
"c": {"type": "Constant", "value": "three"})"));
  EXPECT_TRUE(has(text, "top.json:2:6: error: the parameter \"mass\" is missing")) << text;
  EXPECT_TRUE(has(text, "found: -1")) << text;
  EXPECT_TRUE(has(text, "3 errors")) << text;
}

TEST(Messages, AMissingWireSaysHowToWriteIt) {
  EXPECT_EQ(problems_of(diagram(R"("g": {"type": "Gain", "gain": 1})")),
            R"(top.json:2:1: error: the input "u" is not wired
  block: g
  at: /blocks/g
  expected: "in": {"u": "block.output"}
  hint: Signal
1 error)");
}

TEST(Messages, OneWireIntoAnInputThatTakesOne) {
  EXPECT_TRUE(has(
      problems_of(diagram(
          R"("c": {"type": "Clock"}, "g": {"type": "Gain", "gain": 1, "in": {"u": ["c.time", "c.time"]}})")),
      "the input \"u\" takes one wire"));
}

TEST(Messages, AWireToNowhereIsToldOnceHoweverManyReadIt) {
  DiagramFolder folder;
  folder.with(
      "s.json",
      R"({"loopwright": 1, "inputs": {"u": {}}, "blocks": {"a": {"type": "Gain", "gain": 1, "in": {"u": "u"}}, "b": {"type": "Gain", "gain": 1, "in": {"u": "u"}}}})");
  folder.with("top.json", diagram(R"("s": {"diagram": "s.json", "in": {"u": "nothing.y"}})"));
  EXPECT_TRUE(has(problems_in(folder), "1 error")) << problems_in(folder);
}

TEST(Messages, InputsOfSubdiagramsAreCheckedLikeThoseOfBlocks) {
  DiagramFolder folder;
  folder.with(
      "s.json",
      R"({"loopwright": 1, "inputs": {"force": {}}, "outputs": {"y": "a.y"}, "blocks": {"a": {"type": "Gain", "gain": 1, "in": {"u": "force"}}}})");
  folder.with(
      "top.json",
      diagram(
          R"("c": {"type": "Clock"}, "s": {"diagram": "s.json", "in": {"forse": "c.time"}}, "g": {"type": "Gain", "gain": 1, "in": {"u": "s.z"}})"));
  const std::string text = problems_in(folder);
  EXPECT_TRUE(has(text, "the subdiagram has no input \"forse\"") && has(text, "did you mean \"force\"?"))
      << text;
  EXPECT_TRUE(has(text, "the input \"force\" is not wired")) << text;
  EXPECT_TRUE(has(text, "the subdiagram \"s\" has no output \"z\"")) << text;
}

TEST(Messages, AnOptionalInputReadsItsDefault) {
  const RunResult result = run_of(diagram(
      R"("c": {"type": "Comparison", "operator": ">", "in": {"a": "t.time"}}, "t": {"type": "Clock"})"));
  EXPECT_EQ(signal(result, "c.y").front(), 0) << "0 > 0";
  EXPECT_EQ(signal(result, "c.y").back(), 1) << "1 > 0";
}

TEST(Messages, OfManyBlocksAreAllTold) {
  std::string blocks;
  for (int i = 0; i < 50; ++i)
    blocks += fmt::format(R"({}"b{}": {{"type": "Gain", "gain": "x", "in": {{"v": "b{}.z"}}}})",
                          i ? ",\n" : "", i, i);
  const std::string text = problems_of(diagram(blocks));
  EXPECT_TRUE(has(text, "150 errors")) << text.substr(text.size() - 200);
}

}  // namespace
}  // namespace loopwright::messages_test
