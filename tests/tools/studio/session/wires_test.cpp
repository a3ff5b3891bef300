// What is shown and edited includes every wire: those of named ports and of conditions too.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <set>
#include "tests/tools/studio/session/shipped_diagrams.h"
#include "tools/studio/session/checked_text.h"
#include "tools/studio/session/document.h"

namespace loopwright::studio::wires_test {

namespace {

/// "block.port" of all blocks, and inputs and outputs of the diagram.
std::set<std::string> ports_of(const Json& view, const char* kind, const char* own) {
  std::set<std::string> ports;
  for (const Json& block : view["blocks"])
    for (const Json& port : block[kind])
      ports.insert(block["name"].get<std::string>() + "." + port["name"].get<std::string>());
  for (const Json& port : view[own]) ports.insert(port["name"]);
  return ports;
}

}  // namespace

TEST(ShownWires, LeadFromPortToPortInEveryShippedDiagram) {
  const StudioFolder folder;
  size_t wires = 0;
  for (const std::string& path : shipped_diagrams(folder)) {
    const CheckedText text = check_text(folder.path(path), folder.read(path), {});
    const Json view = view_json(text, "", {}, {});
    const std::set<std::string> sources = ports_of(view, "outputs", "inputs"),
                                targets = ports_of(view, "inputs", "outputs");
    for (const Json& wire : view["wires"]) {
      ++wires;
      const std::string from = wire["from"], to = wire["to"];
      const bool leads_inside = std::ranges::count(from, '.') > 1;
      EXPECT_TRUE(leads_inside || sources.contains(from.substr(0, from.find('[')))) << path << ": " << from;
      EXPECT_TRUE(targets.contains(to)) << path << ": " << to;
    }
    for (const Json& block : view["blocks"])
      if (block["type"] == "StateMachine") {
        EXPECT_FALSE(targets.contains(block["name"].get<std::string>() + ".inputs")) << path;
      }
  }
  EXPECT_GT(wires, 500u);
}

TEST(RenamedBlocks, LeaveEveryShippedDiagramAsItIs) {
  const StudioFolder folder;
  const Folder served(folder.path());
  size_t renamed = 0;
  for (const std::string& path : shipped_diagrams(folder)) {
    if (!check_text(folder.path(path), folder.read(path), {}).loads()) continue;
    Document document(served, path);
    const ParsedText parsed(path, document.text());
    const Value::Member* blocks = parsed.root.find("blocks");
    for (size_t b = 0; blocks && b < blocks->value.members.size(); ++b) {
      const std::string& name = blocks->value.members[b].name;
      const Value intent = json_value(
          fmt::format(R"({{"intent": "rename_block", "name": "{}", "to": "{}_renamed"}})", name, name));
      document.edit({intent}, {}, {}, document.revision());
      ++renamed;
    }
    const CheckedText checked = check_text(folder.path(path), document.text(), {});
    EXPECT_TRUE(checked.loads()) << path << "\n" << checked.problems.text();
  }
  EXPECT_GT(renamed, 500u);
}

TEST(Conditions, AreConnectedReplacedAndTakenAwayLikeWires) {
  const StudioFolder folder;
  shipped_diagrams(folder);
  const Folder served(folder.path());
  Document document(served, "diagrams/examples/enable.json");
  const std::string original = document.text();
  const auto edit = [&](const char* intent) {
    document.edit({json_value(intent)}, {}, {}, document.revision());
  };
  edit(R"({"intent": "connect", "from": "brake.on", "to": "control.enabled_by"})");
  EXPECT_NE(document.text().find(R"("enabled_by": "brake.on")"), std::string::npos);
  edit(R"({"intent": "disconnect", "to": "control.enabled_by"})");
  EXPECT_EQ(document.text().find("enabled_by"), std::string::npos);
  edit(R"({"intent": "connect", "from": "enable.y", "to": "control.enabled_by"})");
  EXPECT_NE(document.text().find(R"("enabled_by": "enable.y")"), std::string::npos);
  for (int i = 0; i < 3; ++i) document.undo();
  EXPECT_EQ(document.text(), original);
}

}  // namespace loopwright::studio::wires_test
