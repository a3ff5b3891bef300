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

}  // namespace loopwright::studio::rename_test
