/// Blocks that are put into a subdiagram: the same simulation, and back to the byte.
#include <gtest/gtest.h>
#include <algorithm>
#include <random>
#include "engine/run/simulation.h"
#include "tests/tools/studio/session/shipped_diagrams.h"
#include "tools/studio/session/checked_text.h"
#include "tools/studio/session/document.h"

namespace loopwright::studio::wrap_test {

namespace {

const char* const axis = R"({
  "loopwright": 1,
  "parameters": {
    "mass":  {"value": 0.5, "unit": "kg"},
    "half":  "=mass/2",
    "other": 3
  },
  "solver": {"method": "rk4", "step": 0.001, "stop": 0.5},
  "inputs": {},
  "blocks": {
    "push": {"type": "Step", "time": 0.1, "after": {"value": 1, "unit": "N"}},
    "net":  {"type": "Sum", "signs": "+-", "in": {"terms": ["push.y", "drag.force"]}},
    "mass": {"type": "Mass", "mass": "=2*half",
             "in": {"force": "net.sum"}},
    "drag": {"type": "ViscousFriction", "damping": 3, "in": {"velocity": "mass.velocity"}}
  },
  "log": ["mass.position", "net.sum"]
}
)";

std::string wrap_of(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "\"" : ", \"") + name + "\"";
  return R"({"intent": "wrap", "blocks": [)" + list + "]}";
}

CheckedText checked(const StudioFolder& folder, const std::string& path) {
  return check_text(folder.path(path), folder.read(path), {});
}

}  // namespace

TEST(Wrap, LeavesTheSimulationToTheBitAndIsUndoneToTheByte) {
  const StudioFolder folder;
  folder.write("axis.json", axis);
  folder.write(
      "axis.experiment.json",
      R"({"loopwright": 1, "data": "x.csv", "drive": {"push.y": {"column": "u"}}, "compare": {"mass.position": {"column": "x"}}})");
  const Folder served(folder.path());
  Document document(served, "axis.json");
  const CheckedText before = checked(folder, "axis.json");
  ASSERT_TRUE(before.loads()) << before.problems.text();
  const Edited edited =
      document.edit({json_value(wrap_of({"net", "mass", "drag"}))}, {}, {}, document.revision());
  EXPECT_EQ(edited.blocks, std::vector<std::string>{"subdiagram"});
  const CheckedText after = checked(folder, "axis.json");
  ASSERT_TRUE(after.loads()) << after.problems.text() << folder.read("axis.json");
  const Level level = find_level(after.parsed->root, "subdiagram", {});
  EXPECT_TRUE(level.block("mass") && level.block("net") && level.block("drag"));
  EXPECT_FALSE(level.block("push"));
  // What the blocks compute with goes with them, also what that is computed from; nothing else does.
  const Value::Member* parameters = level.diagram->find("parameters");
  ASSERT_TRUE(parameters);
  EXPECT_TRUE(parameters->value.find("half") && parameters->value.find("mass"));
  EXPECT_FALSE(parameters->value.find("other"));
  const RunResult a = simulate(*before.checked.plan), b = simulate(*after.checked.plan);
  ASSERT_EQ(a.recording.columns.size(), b.recording.columns.size());
  EXPECT_EQ(b.recording.columns[1].name, "subdiagram.mass.position");
  for (size_t c = 0; c < a.recording.columns.size(); ++c)
    EXPECT_EQ(a.recording.columns[c].values, b.recording.columns[c].values) << a.recording.columns[c].name;
  // The parameters of the diagram still reach the blocks.
  LoadOptions heavier;
  heavier.set = {{"mass", "5 kg"}};
  const auto heavy = check_text(folder.path("axis.json"), folder.read("axis.json"), heavier);
  ASSERT_TRUE(heavy.loads());
  EXPECT_LT(simulate(*heavy.checked.plan).recording.columns[1].values.back(),
            a.recording.columns[1].values.back());
  document.undo();
  EXPECT_EQ(folder.read("axis.json"), axis);
}

TEST(Wrap, GivesOutputsToWhatReadsFromOutside) {
  const StudioFolder folder;
  folder.write("axis.json", axis);
  const Folder served(folder.path());
  Document document(served, "axis.json");
  document.edit({json_value(wrap_of({"mass"}))}, {}, {}, document.revision());
  const CheckedText after = checked(folder, "axis.json");
  ASSERT_TRUE(after.loads()) << after.problems.text() << folder.read("axis.json");
  const Level top = find_level(after.parsed->root, "", {});
  EXPECT_EQ(top.block("drag")->value.find("in")->value.find("velocity")->value.text, "subdiagram.velocity");
}

/// Any blocks of any shipped diagram: what loaded still loads, and undo brings back the same bytes.
TEST(Wrap, AnyBlocksOfAnyShippedDiagram) {
  const StudioFolder folder;
  const Folder served(folder.path());
  std::mt19937 random(5);
  int wrapped = 0;
  for (const std::string& path : shipped_diagrams(folder)) {
    SCOPED_TRACE(path);
    Document document(served, path);
    const std::string original = document.text();
    const CheckedText before = checked(folder, path);
    if (!before.loads()) continue;
    std::vector<std::string> names;
    for (const Value::Member& block : find_level(before.parsed->root, "", {}).blocks().members)
      if (random() % 2) names.push_back(block.name);
    if (names.empty()) continue;
    document.edit({json_value(wrap_of(names))}, {}, {}, document.revision());
    const CheckedText after = checked(folder, path);
    EXPECT_TRUE(after.loads()) << after.problems.text();
    if (after.checked.plan && before.checked.plan) {
      EXPECT_EQ(after.checked.plan->blocks.size(), before.checked.plan->blocks.size());
    }
    document.undo();
    ASSERT_EQ(folder.read(path), original);
    ++wrapped;
  }
  EXPECT_GT(wrapped, 50);
}

}  // namespace loopwright::studio::wrap_test
