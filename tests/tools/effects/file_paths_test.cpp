// A diagram written into another folder: paths are recognized by the kind of their parameter, not by the
// files in the folder.
#include <gtest/gtest.h>
#include "engine/json/json.h"
#include "tests/engine/written_diagram.h"
#include "tools/effects/nest.h"
#include "where.h"

namespace loopwright::file_paths_test {
namespace {

std::string moved(const DiagramFolder& folder, const std::string& text, const std::string& to) {
  return moved_to_folder({folder.path("top.json"), text}, folder.path(to));
}

TEST(FilePaths, TextsThatHappenToBeNamesOfFilesAreLeftAlone) {
  DiagramFolder folder;
  folder.with("m", "").with("x", "").with("t", "").with("data.csv", "t,x\n0,0\n1,1\n").with("out/unused", "");
  const std::string text = diagram(
      R"("m": {"type": "RecordedColumn", "description": "x", "file": "data.csv", "column": "x", "time": "t", "unit": "m"},
  "e": {"type": "Expression", "formula": "x", "names": ["x"], "in": {"arguments": ["m.value"]}})",
      R"("stop": 1, "step": 0.1)", R"(, "title": "m", "log": ["m.value"])");
  std::string expected = text;
  expected.replace(expected.find("data.csv"), 8, "../data.csv");
  EXPECT_EQ(moved(folder, text, "out"), expected);
  EXPECT_EQ(moved(folder, text, ""), text) << "in its own folder nothing changes";
  folder.with("out/top.json", expected);
  EXPECT_EQ(problems_in(folder, "out/top.json"), "");
}

TEST(FilePaths, FilesThatAreNotThereAreFilesStill) {
  DiagramFolder folder;
  folder.with("out/unused", "");
  const std::string text = diagram(R"("m": {"type": "RecordedColumn", "file": "later.csv", "column": "x"})");
  EXPECT_TRUE(has(moved(folder, text, "out"), "\"../later.csv\""));
  const std::string whole =
      diagram(R"("m": {"type": "RecordedColumn", "file": "/data/whole.csv", "column": "x"})");
  EXPECT_EQ(moved(folder, whole, "out"), whole);
}

TEST(FilePaths, ParametersThatReachAFileAreFollowed) {
  DiagramFolder folder;
  folder.with(
      "sub/play.json",
      R"({"loopwright": 1, "parameters": {"record": "own.csv", "column": "x"}, "outputs": {"y": "c.value"},
    "blocks": {"c": {"type": "RecordedColumn", "file": "=record", "column": "=column"}}})");
  folder.with("out/unused", "");
  const std::string text = R"({"$schema": "diagram.schema.json", "loopwright": 1, "solver": {"stop": 1},
  "parameters": {"record": {"value": "=first"}, "first": "a.csv", "column": "a.csv"},
  "blocks": {
    "one": {"diagram": "sub/play.json", "parameters": {"record": "=record", "column": "=column"}},
    "two": {"diagram": "sub/play.json", "parameters": {"record": "b.csv", "column": "b.csv"}},
    "three": {"variants": {"a": {"diagram": {"blocks": {"c": {"type": "RecordedColumn", "file": "c.csv", "column": "x"}}}},
                           "b": {"type": "RecordedColumn", "file": "d.csv", "column": "x"}}}
  }})";
  const std::string result = moved(folder, text, "out");
  for (const char* part :
       {"\"$schema\": \"../diagram.schema.json\"", "\"first\": \"../a.csv\", \"column\": \"a.csv\"",
        "\"record\": \"../b.csv\", \"column\": \"b.csv\"", "\"file\": \"../c.csv\"", "\"file\": \"../d.csv\"",
        "\"diagram\": \"../sub/play.json\"", "{\"value\": \"=first\"}"})
    EXPECT_TRUE(has(result, part)) << part << "\n" << result;
}

TEST(FilePaths, APathThatIsHandedOnIsRelativeToTheFileInWhichItStands) {
  DiagramFolder folder;
  folder.with("inner/play.json",
              R"({"loopwright": 1, "parameters": {"record": "own.csv"}, "outputs": {"y": "c.value"},
    "blocks": {"c": {"type": "RecordedColumn", "file": "=record", "column": "x"}}})");
  folder.with("inner/own.csv", "t,x\n0,1\n1,1\n").with("outer.csv", "t,x\n0,2\n1,2\n");
  folder.with("top.json", diagram(R"("own": {"diagram": "inner/play.json"},
    "given": {"diagram": "inner/play.json", "parameters": {"record": "outer.csv"}})"));
  const RunResult result = simulate(*load_plan(folder.path("top.json")));
  EXPECT_EQ(signal(result, "own.y").back(), 1);
  EXPECT_EQ(signal(result, "given.y").back(), 2);
}

TEST(FilePaths, AShippedDiagramStillLoadsFromElsewhere) {
  DiagramFolder folder;
  const std::string path = LOOPWRIGHT_SOURCE "/diagrams/linear_motor/ps.json";
  Problems problems;
  const auto source = read_source(path, {}, problems);
  folder.with("deep/er/ps.json", moved_to_folder(*source, folder.path("deep/er")));
  EXPECT_EQ(problems_in(folder, "deep/er/ps.json"), "");
  LoadOptions hardware;
  hardware.variants["stage"] = "quanser";
  EXPECT_EQ(problems_in(folder, "deep/er/ps.json", hardware), "") << "the variant that is not active too";
}

}  // namespace
}  // namespace loopwright::file_paths_test
