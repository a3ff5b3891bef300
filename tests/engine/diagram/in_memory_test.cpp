#include "engine/diagram/in_memory.h"
#include <gtest/gtest.h>
#include "engine/json/json.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::in_memory_test {

namespace {

std::shared_ptr<const Diagram> read(const std::string& text, const std::string& path, Problems& problems,
                                    const LoadOptions& options = {}) {
  const Value root = parse_json(std::make_shared<SourceFile>(SourceFile{path, text}), problems);
  return read_diagram(root, path, options, problems);
}

}  // namespace

TEST(InMemory, ADiagramIsReadAsFromItsFile) {
  DiagramFolder folder;
  folder.with("part.json", R"({"loopwright": 1, "parameters": {"k": 2}, "blocks": {}})");
  Problems problems;
  const auto diagram = read(R"({"loopwright": 1, "blocks": {"part": {"diagram": "part.json"}}})",
                            folder.path("top.json"), problems, {.set = {{"part.k", "3"}}});
  EXPECT_EQ(problems.text(), "");
  EXPECT_EQ(diagram->blocks.at(0).subdiagram->parameters.at(0).value.number, 3);
}

TEST(InlineSubdiagram, ItsParametersAndWiresAreThoseOfAFile) {
  const RunResult result = run_of(diagram(
      R"("source": {"type": "Constant", "value": 3},
         "twice": {"diagram": {"parameters": {"gain": 1}, "inputs": {"u": {}}, "outputs": {"y": "gain.y"},
                               "blocks": {"gain": {"type": "Gain", "gain": "=gain", "in": {"u": "u"}}}},
                   "parameters": {"gain": 2}, "in": {"u": "source.y"}},
         "last": {"type": "Gain", "gain": 1, "in": {"u": "twice.y"}})"));
  EXPECT_EQ(signal(result, "last.y").back(), 6);
}

TEST(InlineSubdiagram, ProblemsNameTheirPlace) {
  const std::string text =
      problems_of(diagram(R"("part": {"diagram": {"blocks": {"a": {"type": "Gian"}}, "lgo": []}})"));
  EXPECT_TRUE(has(text, "top.json:2:")) << text;
  EXPECT_TRUE(has(text, "/blocks/part/diagram/lgo")) << text;
  EXPECT_TRUE(has(text, "did you mean \"log\"")) << text;
}

}  // namespace loopwright::in_memory_test
