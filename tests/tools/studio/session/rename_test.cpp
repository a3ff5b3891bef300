/// Names that other places of a file use.
#include <gtest/gtest.h>
#include "tests/tools/studio/session/shipped_diagrams.h"
#include "tools/studio/session/checked_text.h"
#include "tools/studio/session/document.h"

namespace loopwright::studio::rename_test {

TEST(RenamedParameter, IsFollowedByTheGuardsAndValuesOfAStateMachine) {
  const StudioFolder folder;
  const Folder served(folder.path());
  shipped_diagrams(folder);
  const std::string path = "diagrams/examples/state_machine.json";
  Document document(served, path);
  const std::string original = document.text();
  for (const char* name : {"warm_up", "reach", "speed"})
    document.edit({json_value(std::string(R"({"intent": "rename_parameter", "name": ")") + name +
                              R"(", "to": "new_)" + name + R"("})")},
                  {}, {}, document.revision());
  const CheckedText renamed = check_text(folder.path(path), document.text(), {});
  EXPECT_TRUE(renamed.loads()) << renamed.problems.text();
  for (const char* use : {"after(new_warm_up)", "position > new_reach", "=new_speed", "=-new_speed"})
    EXPECT_NE(document.text().find(use), std::string::npos) << use;
  for (int i = 0; i < 3; ++i) document.undo();
  EXPECT_EQ(document.text(), original);
}

/// Under the new name the formula would read its own signal.
TEST(RenamedParameter, IsRefusedWhereABlockHasTheNewNameItself) {
  const StudioFolder folder;
  for (const char* own : {R"("names": ["u"])", R"("names": ["v"], "constants": [{"name": "u", "value": 7}])"}) {
    const std::string signal = std::string(own).find("\"v\"") == std::string::npos ? "u" : "v";
    const std::string text = R"({
  "loopwright": 1,
  "parameters": {"k": 3},
  "solver": {"method": "rk4", "step": 0.01, "stop": 1},
  "blocks": {
    "one": {"type": "Constant", "value": 2},
    "law": {"type": "Expression", "formula": "k*)" + signal +
                             R"(", )" + own + R"(, "in": {"arguments": ["one.y"]}}
  }
}
)";
    folder.write("law.json", text);
    const Folder served(folder.path());
    Document document(served, "law.json");
    const auto renamed = [&](const char* to) {
      return document.edit({json_value(std::string(R"({"intent": "rename_parameter", "name": "k", "to": ")") + to + R"("})")},
                           {}, {}, document.revision());
    };
    EXPECT_THROW(renamed("u"), Refused);
    EXPECT_EQ(folder.read("law.json"), text);
    renamed("gain");
    EXPECT_NE(document.text().find("gain*" + signal), std::string::npos);
  }
}

}  // namespace loopwright::studio::rename_test
