// Every shipped diagram determines the unit of each of its wires.
#include <filesystem>
#include <gtest/gtest.h>
#include "engine/json/file_kind.h"
#include "tests/engine/written_diagram.h"
#include "where.h"

namespace loopwright::strict_units_test {
namespace {

std::vector<std::string> shipped_diagrams() {
  std::vector<std::string> paths;
  for (const char* folder : {"diagrams", "hw"})
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(std::filesystem::path(LOOPWRIGHT_SOURCE) / folder)) {
      if (entry.path().extension() != ".json") continue;
      Problems ignored;
      if (kind_of_file(entry.path().string(), ignored) == FileKind::diagram)
        paths.push_back(entry.path().string());
    }
  std::ranges::sort(paths);
  return paths;
}

/// Problems and wires without a unit, as `check --strict-units` reports them.
std::string told_of(const std::string& path, const LoadOptions& options = {}) {
  Problems problems;
  const auto diagram = load_diagram(path, options, problems);
  if (diagram && !diagram->inputs.empty())
    refuse(check_part(*diagram, problems), problems);
  else if (const auto plan = diagram ? compile(*diagram, problems) : nullptr)
    refuse(plan->without_unit, problems);
  return problems.has_errors() || !diagram ? problems.text() : "";
}

TEST(StrictUnits, HoldForEveryDiagramThatIsShipped) {
  const auto paths = shipped_diagrams();
  EXPECT_GT(paths.size(), 100u);
  for (const std::string& path : paths) EXPECT_EQ(told_of(path), "") << path;
}

TEST(StrictUnits, HoldForTheDiagramsOfTheDocs) {
  for (const char* file : {"README.md", "docs/diagram_format.md"}) {
    std::ifstream stream(std::filesystem::path(LOOPWRIGHT_SOURCE) / file);
    const std::string text(std::istreambuf_iterator<char>(stream), {});
    const size_t begin = text.find("```json\n{\n  \"loopwright\"") + 8, end = text.find("\n```", begin);
    ASSERT_LT(end, text.size()) << file;
    DiagramFolder folder;
    folder.with("first.json", text.substr(begin, end - begin));
    EXPECT_EQ(told_of(folder.path("first.json")), "") << file;
  }
}

TEST(StrictUnits, RefuseADiagramWithoutUnits) {
  DiagramFolder folder;
  folder.with(
      "top.json",
      diagram(
          R"("c": {"type": "Constant", "value": 1}, "g": {"type": "Gain", "gain": 2, "in": {"u": "c.y"}})"));
  const std::string text = told_of(folder.path("top.json"));
  EXPECT_TRUE(has(text, "nothing decides the unit of c.y")) << text;
  EXPECT_TRUE(has(text, "nothing decides the unit of g.y")) << text;
}

}  // namespace
}  // namespace loopwright::strict_units_test
