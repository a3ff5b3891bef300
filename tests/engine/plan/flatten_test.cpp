// Subdiagrams are dissolved before blocks are ordered: they add no delay, create no false algebraic loop, and
// keep their names.
#include <gtest/gtest.h>
#include <algorithm>
#include "tests/engine/written_diagram.h"

namespace loopwright::flatten_test {
namespace {

/// A subdiagram whose output is its input, through `inner`.
std::string pass_through(const std::string& inner) {
  return R"({"loopwright": 1, "inputs": {"u": {}}, "outputs": {"y": ")" + inner + R"("}, "blocks": {)";
}

TEST(Flatten, TwentyNestedPassThroughsAddNoDelay) {
  DiagramFolder folder;
  for (int depth = 0; depth < 20; ++depth)
    folder.with(
        fmt::format("level{}.json", depth),
        pass_through("inside.y") +
            fmt::format(R"("inside": {{"diagram": "level{}.json", "in": {{"u": "u"}}}}}}}})", depth + 1));
  folder.with("level20.json",
              pass_through("gain.y") + R"("gain": {"type": "Gain", "gain": 2, "in": {"u": "u"}}}})");
  folder.with(
      "top.json",
      diagram(
          R"("source": {"type": "Clock"}, "deep": {"diagram": "level0.json", "in": {"u": "source.time"}})",
          R"("stop": 1, "step": 0.1)", R"(, "log": ["source.time", "deep.y"])"));
  const auto plan = load_plan(folder.path("top.json"));
  EXPECT_EQ(plan->blocks.size(), 2u) << "a nest is no block";
  const RunResult result = simulate(*plan);
  ASSERT_EQ(result.recording.rows(), 11u);
  for (size_t i = 0; i < 11; ++i)
    EXPECT_EQ(signal(result, "deep.y")[i], 2 * signal(result, "source.time")[i]) << i;
}

TEST(Flatten, TwentySampledPassThroughsInARowAddNoDelayEither) {
  DiagramFolder folder;
  folder.with("pass.json",
              pass_through("gain.y") +
                  R"("gain": {"type": "Gain", "gain": 1, "sample_time": 0.1, "in": {"u": "u"}}}})");
  std::string blocks =
      R"("p0": {"diagram": "pass.json", "in": {"u": "source.y"}}, "source": {"type": "Noise", "standard_deviation": 1, "sample_time": 0.1})";
  for (int i = 1; i < 20; ++i)
    blocks = fmt::format(R"("p{}": {{"diagram": "pass.json", "in": {{"u": "p{}.y"}}}}, )", i, i - 1) +
             blocks;  // written backwards
  const auto plan =
      load_plan(folder.with("top.json", diagram(blocks, R"("stop": 1)", R"(, "log": ["source.y", "p19.y"])"))
                    .path("top.json"));
  const RunResult result = simulate(*plan);
  EXPECT_EQ(signal(result, "source.y"), signal(result, "p19.y"));
}

TEST(Flatten, AnInputWiredStraightToAnOutputIsAWire) {
  DiagramFolder folder;
  folder.with("wire.json", pass_through("u") + "}}");
  folder.with(
      "top.json",
      diagram(
          R"("source": {"type": "Constant", "value": 7}, "wire": {"diagram": "wire.json", "in": {"u": "source.y"}},
    "gain": {"type": "Gain", "gain": 3, "in": {"u": "wire.y"}})"));
  EXPECT_EQ(signal(simulate(*load_plan(folder.path("top.json"))), "gain.y").back(), 21);
}

TEST(Flatten, ATwoOutputSubdiagramMakesNoFalseRing) {
  // The path from u to the output that is fed back contains an integrator. Only `direct` feeds through.
  DiagramFolder folder;
  folder.with(
      "two.json",
      R"({"loopwright": 1, "inputs": {"u": {}}, "outputs": {"slow": "x.y", "direct": "gain.y"}, "blocks": {
    "x": {"type": "Integrator", "in": {"u": "u"}}, "gain": {"type": "Gain", "gain": 1, "in": {"u": "u"}}}})");
  folder.with(
      "top.json",
      diagram(
          R"("two": {"diagram": "two.json", "in": {"u": "error.sum"}}, "one": {"type": "Constant", "value": 1},
    "error": {"type": "Sum", "signs": "+-", "in": {"terms": ["one.y", "two.slow"]}})"));
  EXPECT_EQ(problems_in(folder), "");
}

TEST(Flatten, ATwoOutputBlockMakesNoFalseRing) {
  // Mass: acceleration depends on the force, velocity is a state. Friction that depends on velocity closes no
  // algebraic loop.
  EXPECT_EQ(
      problems_of(diagram(
          R"("stage": {"type": "Mass", "mass": 2, "in": {"force": "sum.sum"}}, "push": {"type": "Constant", "value": 1},
    "friction": {"type": "ViscousFriction", "damping": 1, "in": {"velocity": "stage.velocity"}},
    "sum": {"type": "Sum", "signs": "+-", "in": {"terms": ["push.y", "friction.force"]}})")),
      "");
}

TEST(Flatten, PortsOfEveryDepthCanBeAskedForByPath) {
  DiagramFolder folder;
  folder.with("inner.json",
              pass_through("gain.y") + R"("gain": {"type": "Gain", "gain": 2, "in": {"u": "u"}}}})");
  folder.with("outer.json",
              pass_through("inner.y") + R"("inner": {"diagram": "inner.json", "in": {"u": "u"}}}})");
  folder.with(
      "top.json",
      diagram(
          R"("source": {"type": "Constant", "value": 1}, "outer": {"diagram": "outer.json", "in": {"u": "source.y"}})"));
  const auto plan = load_plan(folder.path("top.json"));
  const auto source = plan->find("source.y"), gain = plan->find("outer.inner.gain.y");
  ASSERT_EQ(source.size(), 1u);
  ASSERT_EQ(gain.size(), 1u);
  EXPECT_NE(source, gain);
  EXPECT_EQ(plan->find("outer.u"), source) << "an input is what feeds it";
  EXPECT_EQ(plan->find("outer.inner.gain.u"), source);
  EXPECT_EQ(plan->find("outer.y"), gain);
  EXPECT_EQ(plan->find("outer.y[0]"), gain);
  EXPECT_EQ(plan->name_of(gain[0]), "outer.inner.gain.y");
  for (const char* wrong : {"", "outer", "outer.z", "outer.y[1]", "outer.y[", "outer.y[]", "outer.y[0",
                            "outer.y[x]", "outer.y[-1]", "outer.y[0]x", "outer.y[99999999999999999999]"})
    EXPECT_TRUE(plan->find(wrong).empty()) << wrong;
}

TEST(Flatten, LogPatternsTakeEveryOutputBelowAName) {
  DiagramFolder folder;
  folder.with(
      "inner.json",
      pass_through("b.y") +
          R"("a": {"type": "Gain", "gain": 2, "in": {"u": "u"}}, "b": {"type": "Gain", "gain": 2, "in": {"u": "a.y"}}}})");
  const std::string blocks =
      R"("source": {"type": "Constant", "value": 1}, "s": {"diagram": "inner.json", "in": {"u": "source.y"}}, "sb": {"type": "Clock"})";
  const auto names = [&](const std::string& log) {
    folder.with("top.json", diagram(blocks, R"("stop": 1)", ", \"log\": " + log));
    const auto plan = load_plan(folder.path("top.json"));
    std::vector<std::string> logged;
    for (const Plan::Logged& l : plan->log) logged.push_back(l.name);
    return logged;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names(R"(["s.*"])"), (Names{"s.a.y", "s.b.y"}))
      << "and not the block \"sb\", whose name begins alike";
  EXPECT_EQ(names(R"(["s.a.*", "source.y"])"), (Names{"s.a.y", "source.y"}));
  EXPECT_EQ(names("[]"), (Names{"source.y", "s.y", "sb.time"})) << "without a log: what stands at the top";
  EXPECT_EQ(names(R"(["s.a.u"])"), (Names{"s.a.u"})) << "an input is logged as what feeds it";
}

TEST(Flatten, TheSameSignalTwiceInALogIsAnError) {
  const std::string text =
      problems_of(diagram(R"("c": {"type": "Clock"})", R"("stop": 1)", R"(, "log": ["c.time", "c.*"])"));
  EXPECT_TRUE(has(text, "\"c.time\" is logged twice")) << text;
  EXPECT_TRUE(has(text, "top.json:3:")) << text;
}

TEST(Flatten, APatternThatMatchesNothingIsAnError) {
  EXPECT_TRUE(
      has(problems_of(diagram(R"("c": {"type": "Clock"})", R"("stop": 1)", R"(, "log": ["clock.*"])")),
          "nothing matches \"clock.*\""));
}

TEST(Flatten, DeepNestsCompileAndTooDeepOnesAreAnErrorNotACrash) {
  const auto nest = [](int depth) {
    DiagramFolder folder;
    for (int i = 0; i < depth; ++i)
      folder.with(fmt::format("n{}.json", i),
                  pass_through("inside.y") +
                      fmt::format(R"("inside": {{"diagram": "n{}.json", "in": {{"u": "u"}}}}}}}})", i + 1));
    folder.with(fmt::format("n{}.json", depth),
                pass_through("gain.y") + R"("gain": {"type": "Gain", "gain": 1, "in": {"u": "u"}}}})");
    folder.with(
        "top.json",
        diagram(
            R"("source": {"type": "Clock"}, "deep": {"diagram": "n0.json", "in": {"u": "source.time"}})"));
    return problems_in(folder);
  };
  EXPECT_EQ(nest(30), "");
  const std::string text = nest(40);
  EXPECT_TRUE(has(text, "subdiagrams nest deeper than 32 levels")) << text;
  EXPECT_TRUE(has(text, "1 error")) << "and nothing that only follows from it\n" << text;
}

TEST(Flatten, EmptyNestsAndUnusedOutputsAreFine) {
  DiagramFolder folder;
  folder.with("nothing.json", R"({"loopwright": 1, "blocks": {}})");
  folder.with("top.json", diagram(R"("n": {"diagram": "nothing.json"}, "c": {"type": "Clock"})"));
  EXPECT_EQ(problems_in(folder), "");
}

TEST(Flatten, OutputsThatLeadRoundInACircleAreAnErrorNotAHang) {
  DiagramFolder folder;
  folder.with("wire.json", pass_through("u") + "}}");
  folder.with(
      "top.json",
      diagram(
          R"("a": {"diagram": "wire.json", "in": {"u": "b.y"}}, "b": {"diagram": "wire.json", "in": {"u": "a.y"}},
    "g": {"type": "Gain", "gain": 1, "in": {"u": "a.y"}})"));
  EXPECT_TRUE(has(problems_in(folder), "circle")) << problems_in(folder);
}

}  // namespace
}  // namespace loopwright::flatten_test
