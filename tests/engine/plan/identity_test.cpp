// The hash of a plan: equal for plans with equal results, different for any change of a number.
#include <gtest/gtest.h>
#include <fstream>
#include <set>
#include <sstream>
#include "tests/engine/written_diagram.h"
#include "where.h"

namespace loopwright::identity_test {
namespace {

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::string servo(std::string_view gain, std::string_view solver = R"("stop": 1, "step": 0.01)",
                  std::string_view more = "") {
  return diagram(
      fmt::format(
          R"("x": {{"type": "Integrator", "initial": 1, "in": {{"u": "g.y"}}}}, "g": {{"type": "Gain", "gain": {}, "in": {{"u": "x.y"}}}})",
          gain),
      solver, more);
}

TEST(Identity, FormattingTitlesAndWaysToWriteANumberDoNotMatter) {
  const std::string hash = plan_of(servo("-2"))->hash;
  EXPECT_EQ(hash.size(), 16u);
  EXPECT_EQ(plan_of(servo("-2.0"))->hash, hash);
  EXPECT_EQ(plan_of(servo("\"=-1*2\""))->hash, hash);
  EXPECT_EQ(plan_of(servo("  \n\t-2e0 "))->hash, hash);
  EXPECT_EQ(
      plan_of(servo("-2", R"("stop": 1, "step": 0.01)", R"(, "title": "A title", "description": "and why")"))
          ->hash,
      hash);
}

TEST(Identity, EveryParameterAndSettingMatters) {
  std::set<std::string> hashes;
  size_t variants = 0;
  const auto add = [&](const std::string& text, const LoadOptions& options = {}) {
    hashes.insert(plan_of(text, options)->hash), ++variants;
  };
  add(servo("-2"));
  add(servo("-2.0000000000000004"));
  add(servo("-2", R"("stop": 2, "step": 0.01)"));
  add(servo("-2", R"("stop": 1, "step": 0.02)"));
  add(servo("-2", R"("stop": 1, "step": 0.01, "record_step": 0.1)"));
  add(servo("-2", R"("stop": 1, "step": 0.01, "method": "heun")"));
  add(servo("-2", R"("stop": 1, "step": 0.01, "seed": 2)"));
  add(servo("-2", R"("stop": 1, "method": "dopri5")"));
  add(servo("-2", R"("stop": 1, "method": "dopri5", "relative_tolerance": 1e-7)"));
  add(servo("-2", R"("stop": 1, "step": 0.01)", R"(, "log": ["x.y"])"));
  add(servo("-2"), {.set = {{"x.initial", "2"}}, .variants = {}, .drives = {}});
  EXPECT_EQ(hashes.size(), variants);
}

// ---- what was read ----

/// Plays a recording through a subdiagram.
DiagramFolder& with_recording(DiagramFolder& folder, std::string_view rows = "0,1\n1,2\n") {
  folder.with("data/track.csv", "time,x\n" + std::string(rows));
  folder.with("parts/player.json",
              R"({"loopwright": 1, "outputs": {"x": "track.value"},
  "blocks": {"track": {"type": "RecordedColumn", "file": "../data/track.csv", "column": "x"}}})");
  folder.with(
      "top.json",
      diagram(
          R"("p": {"diagram": "parts/player.json"}, "g": {"type": "Gain", "gain": 2, "in": {"u": "p.x"}})"));
  return folder;
}
std::string changed(const Plan& before, const Plan& now) {
  return changes_with_build(before.identity, now.identity);
}

TEST(Identity, TheBytesOfEveryFileThatWasReadMatter) {
  DiagramFolder folder;
  const auto before = load_plan(with_recording(folder).path("top.json"));
  EXPECT_EQ(load_plan(folder.path("top.json"))->hash, before->hash);
  ASSERT_EQ(before->identity.files.size(), 2u);
  EXPECT_EQ(before->identity.files[0].path, "data/track.csv");
  EXPECT_EQ(before->identity.files[1].path, "parts/player.json");

  const auto now = load_plan(with_recording(folder, "0,1\n1,2.0\n").path("top.json"));  // the same numbers
  EXPECT_NE(now->hash, before->hash);
  EXPECT_EQ(now->identity.structure, before->identity.structure);
  EXPECT_EQ(changed(*before, *now), "the file \"data/track.csv\" has changed");

  with_recording(folder);
  folder.with("parts/player.json", text_of(folder.path("parts/player.json")) + "\n");
  EXPECT_EQ(changed(*before, *load_plan(folder.path("top.json"))),
            "the file \"parts/player.json\" has changed");
}

TEST(Identity, MovesWithItsFilesToAnotherFolder) {
  DiagramFolder here, there;
  const auto before = load_plan(with_recording(here).path("top.json")),
             now = load_plan(with_recording(there).path("top.json"));
  EXPECT_EQ(before->hash, now->hash);
  EXPECT_EQ(changed(*before, *now), "");
}

TEST(Identity, FilesWithExchangedContentsMatter) {
  DiagramFolder folder;
  const auto with = [&](const std::string& a, const std::string& b, const std::string& c) {
    std::string blocks;
    for (const auto& [name, x] : {std::pair("a", a), std::pair("b", b), std::pair("c", c)}) {
      folder.with(fmt::format("{}.csv", name), "time,x\n0," + x + "\n1,2\n");
      blocks += fmt::format(R"({}"{}": {{"type": "RecordedColumn", "file": "{}.csv", "column": "x"}})",
                            blocks.empty() ? "" : ", ", name, name);
    }
    return load_plan(folder.with("top.json", diagram(blocks)).path("top.json"));
  };
  const auto before = with("1", "2", "2");
  const auto exchanged = with("2", "1", "2"), other_count = with("1", "2", "1");
  EXPECT_NE(exchanged->hash, before->hash);
  EXPECT_NE(other_count->hash, before->hash);
  EXPECT_EQ(changed(*before, *exchanged), "the file \"a.csv\" has changed; the file \"b.csv\" has changed");
  EXPECT_EQ(with("1", "2", "2")->hash, before->hash);
}

TEST(Identity, DoesNotDependOnTheWayThePathIsWritten) {
  DiagramFolder folder;
  const std::string path = with_recording(folder).path("top.json");
  const auto relative =
      std::filesystem::path(path).lexically_relative(std::filesystem::current_path()).string();
  EXPECT_EQ(load_plan(relative)->hash, load_plan(path)->hash);
}

TEST(Identity, TheModelOfALearnedBlockMatters) {
  DiagramFolder folder;
  const auto examples = std::filesystem::path(LOOPWRIGHT_SOURCE) / "diagrams/examples";
  const std::string model = text_of((examples / "gpr.model.json").string());
  folder.with("gpr.json", text_of((examples / "gpr.json").string())).with("gpr.model.json", model);
  const auto before = load_plan(folder.path("gpr.json"));
  folder.with("gpr.model.json", model + " ");
  EXPECT_EQ(changed(*before, *load_plan(folder.path("gpr.json"))), "the file \"gpr.model.json\" has changed");
}

TEST(Identity, TheProgramsBuildMatters) {
  const auto plan = plan_of(servo("-2"));
  Identity other = plan->identity;
  EXPECT_EQ(other.build, program_build());
  EXPECT_EQ(other.build.size(), 16u);
  other.build = "0123456789abcdef";
  EXPECT_NE(other.hash(), plan->hash);
  EXPECT_TRUE(changes(other, plan->identity).empty());
  EXPECT_TRUE(has(changes_with_build(other, plan->identity), "another build (0123456789abcdef, here "));
}

TEST(Identity, IsReadBackFromTheFactsOfARecording) {
  DiagramFolder folder;
  const auto plan = load_plan(with_recording(folder).path("top.json"));
  EXPECT_EQ(identity_of(simulate(*plan).recording.facts).hash(), plan->hash);
  EXPECT_EQ(identity_of(facts_of(to_text(plan->identity.facts()))).hash(), plan->hash);
  Identity odd = plan->identity;
  odd.files = {{"a: b\n\x1b.csv", "0"}};
  EXPECT_EQ(identity_of(facts_of(to_text(odd.facts()))).files[0].path, odd.files[0].path);
}

TEST(Identity, EffectiveParametersAreListedWithUnitsAndDefaults) {
  const auto plan = plan_of(
      diagram(R"("x": {"type": "LowPass", "cutoff": "=2*k", "in": {"u": "c.time"}}, "c": {"type": "Clock"})",
              R"("stop": 1)", R"(, "parameters": {"k": {"value": 3, "unit": "rad/s"}})"));
  const auto value = [&](std::string_view name) {
    for (const auto& [n, v] : plan->parameters)
      if (n == name) return v;
    return std::string("none");
  };
  EXPECT_EQ(value("x.cutoff"), "6 rad/s");
  EXPECT_EQ(value("x.order"), "2") << "a default";
  EXPECT_TRUE(value("k").starts_with("3 ")) << value("k");
}

TEST(Identity, OverridesAreEchoedInTheRecording) {
  const RunResult result =
      simulate(*plan_of(servo("-2"), {.set = {{"g.gain", "-3"}}, .variants = {}, .drives = {}}));
  bool found = false;
  for (const auto& [name, value] : result.recording.facts)
    found |= name == "parameter g.gain" && value == "-3";
  EXPECT_TRUE(found);
}

TEST(Identity, DescribeShowsOrderRatesAndStates) {
  const std::string text =
      describe(*plan_of(diagram(R"("x": {"type": "Integrator", "in": {"u": "h.y"}},
"h": {"type": "ZeroOrderHold", "sample_time": 0.1, "in": {"u": "g.y"}}, "g": {"type": "Gain", "gain": 1, "in": {"u": "s.y"}}, "s": {"type": "Sine", "frequency": 1},
"c": {"type": "Constant", "value": 3})",
                                R"("stop": 1, "step": 0.05)", R"(, "title": "A small one")")));
  EXPECT_TRUE(text.starts_with("A small one\n")) << text;
  for (const char* part :
       {"5 blocks", "1 states", "1 rates", "tick 1/20 s", "rk4 at 0.05 s", "a row every 0.1 s",
        "every 2 ticks from tick 0: 0.1 s", "once               c (Constant) y",
        "0.1 s              h (ZeroOrderHold) y", "x (Integrator): 1 (y)"})
    EXPECT_TRUE(has(text, part)) << part << "\n" << text;
  EXPECT_LT(text.find("s (Sine) y"), text.find("g (Gain) y"));
  EXPECT_LT(text.find("g (Gain) y"), text.find("h (ZeroOrderHold) y"));
}

}  // namespace
}  // namespace loopwright::identity_test
