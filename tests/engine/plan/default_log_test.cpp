// What a diagram without "log" records.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "tests/engine/written_diagram.h"

namespace loopwright::default_log_test {
namespace {

using testing::ElementsAre;

std::vector<std::string> logged(const Plan& plan) {
  std::vector<std::string> names;
  for (const Plan::Logged& log : plan.log) names.push_back(log.name);
  return names;
}

TEST(DefaultLog, OfThreeAxesAllAreRecorded) {
  DiagramFolder folder;
  folder.with(
      "axis.json",
      R"({"loopwright": 1, "inputs": {"u": ""}, "outputs": {"position": "x.y", "speed": "v.y"}, "blocks": {
  "v": {"type": "Integrator", "in": {"u": "u"}}, "x": {"type": "Integrator", "in": {"u": "v.y"}}}})");
  folder.with("top.json", diagram(R"("ref": {"type": "Constant", "value": 1},
  "a": {"diagram": "axis.json", "in": {"u": "ref.y"}}, "b": {"diagram": "axis.json", "in": {"u": "a.speed"}},
  "c": {"diagram": "axis.json", "in": {"u": "ref.y"}}, "end": {"type": "Gain", "gain": 2, "in": {"u": "c.position"}})"));
  const auto plan = load_plan(folder.path("top.json"), {});
  EXPECT_THAT(logged(*plan), ElementsAre("ref.y", "a.position", "a.speed", "b.position", "b.speed",
                                         "c.position", "c.speed", "end.y"));
  const RunResult result = simulate(*plan);
  EXPECT_NEAR(signal(result, "a.speed").back(), 1, 1e-12);
  EXPECT_NEAR(signal(result, "end.y").back(), 1, 1e-12);
}

TEST(DefaultLog, OfASubdiagramWithoutOutputsItsBlocksAreRecorded) {
  const auto plan = plan_of(diagram(R"("outer": {"diagram": {"blocks": {
    "c": {"type": "Constant", "value": 1},
    "inner": {"diagram": {"outputs": {"y": "g.y"}, "blocks": {"c": {"type": "Constant", "value": 2}, "g": {"type": "Gain", "gain": 3, "in": {"u": "c.y"}}}}},
    "closed": {"diagram": {"blocks": {"k": {"type": "Constant", "value": 4}}}}}}})"));
  EXPECT_THAT(logged(*plan), ElementsAre("outer.c.y", "outer.inner.y", "outer.closed.k.y"));
}

TEST(DefaultLog, WhatIsSaidIsAllThatIsRecorded) {
  const auto plan = plan_of(diagram(
      R"("c": {"type": "Constant", "value": 1}, "g": {"type": "Gain", "gain": 2, "in": {"u": "c.y"}})",
      R"("stop": 1, "step": 0.1)", R"(, "log": ["g.y"])"));
  EXPECT_THAT(logged(*plan), ElementsAre("g.y"));
}

}  // namespace
}  // namespace loopwright::default_log_test
