// Scalar blocks accept vectors element by element. Vector ports accept whole vectors.
#include <gtest/gtest.h>
#include "tests/engine/written_diagram.h"

namespace loopwright::vectors_test {
namespace {

constexpr std::string_view three =
    R"("a": {"type": "Constant", "value": 1}, "b": {"type": "Constant", "value": 2}, "c": {"type": "Constant", "value": 3},
"v": {"type": "Pack", "in": {"elements": ["a.y", "b.y", "c.y"]}})";

std::string with_three(std::string_view more) { return diagram(fmt::format("{},\n{}", three, more)); }
double last(const RunResult& result, std::string_view name) { return signal(result, name).back(); }

TEST(Vectors, AScalarBlockStandsOnceForEachElement) {
  const auto plan = plan_of(with_three(
      R"("g": {"type": "Gain", "gain": 10, "in": {"u": "v.y"}}, "x": {"type": "Integrator", "in": {"u": "g.y"}})"));
  EXPECT_EQ(plan->states, 3);
  EXPECT_EQ(plan->find("x.y").size(), 3u);
  EXPECT_EQ(plan->find("g.y[2]").size(), 1u);
  const RunResult result = simulate(*plan);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(last(result, fmt::format("g.y[{}]", i)), 10 * (i + 1));
    EXPECT_NEAR(last(result, fmt::format("x.y[{}]", i)), 10 * (i + 1), 1e-12);
  }
}

TEST(Vectors, AScalarNextToAVectorIsTakenForEveryElement) {
  const RunResult result =
      run_of(with_three(R"("s": {"type": "Sum", "signs": "+-", "in": {"terms": ["v.y", "a.y"]}})"));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(last(result, fmt::format("s.sum[{}]", i)), i);
}

TEST(Vectors, PackAndUnpackAreInverse) {
  const RunResult result = run_of(with_three(
      R"("w": {"type": "Pack", "in": {"elements": ["c.y", "v.y", "a.y"]}}, "u": {"type": "Unpack", "index": 3, "in": {"u": "w.y"}})"));
  EXPECT_EQ(last(result, "u.y"), 3) << "3, 1, 2, 3, 1: vectors are strung in";
  EXPECT_EQ(last(result, "w.y[4]"), 1);
}

TEST(Vectors, AnElementIsASignal) {
  const RunResult result = run_of(with_three(R"("g": {"type": "Gain", "gain": 10, "in": {"u": "v.y[1]"}})"));
  EXPECT_EQ(last(result, "g.y"), 20);
}

TEST(Vectors, ScatteredScalarsReachAVectorPort) {
  const RunResult result = run_of(with_three(
      R"("g": {"type": "Gain", "gain": 1, "in": {"u": "v.y"}}, "x": {"type": "Integrator", "in": {"u": "g.y"}},
    "m": {"type": "MatrixGain", "matrix": [[1, 1, 1], [1, 0, -1]], "in": {"u": "x.y"}})"));
  EXPECT_NEAR(last(result, "m.y[0]"), 6, 1e-12);
  EXPECT_NEAR(last(result, "m.y[1]"), -2, 1e-12);
}

TEST(Vectors, VectorsThroughSubdiagramsKeepTheirWidth) {
  DiagramFolder folder;
  folder.with(
      "gain.json",
      R"({"loopwright": 1, "inputs": {"u": {}}, "outputs": {"y": "g.y"}, "blocks": {"g": {"type": "Gain", "gain": 2, "in": {"u": "u"}}}})");
  folder.with(
      "top.json",
      with_three(
          R"("s": {"diagram": "gain.json", "in": {"u": "v.y"}}, "e": {"type": "Gain", "gain": 1, "in": {"u": "s.y[2]"}})"));
  const auto plan = load_plan(folder.path("top.json"));
  EXPECT_EQ(plan->find("s.y").size(), 3u);
  EXPECT_EQ(last(simulate(*plan), "e.y"), 6);
}

TEST(Vectors, WidthsThatDoNotMatchAreAnError) {
  const std::string text = problems_of(with_three(
      R"("w": {"type": "Pack", "in": {"elements": ["a.y", "b.y"]}}, "s": {"type": "Sum", "in": {"terms": ["v.y", "w.y"]}})"));
  EXPECT_TRUE(has(text, "the input \"terms\" has the wrong width")) << text;
  EXPECT_TRUE(has(text, "a scalar or 3 elements")) << text;
  EXPECT_TRUE(has(text, "\"w.y\" with 2 elements")) << text;
}

TEST(Vectors, AMatrixOfTheWrongSizeIsAnError) {
  const std::string text =
      problems_of(with_three(R"("m": {"type": "MatrixGain", "matrix": [[1, 1]], "in": {"u": "v.y"}})"));
  EXPECT_TRUE(has(text, "expected: 2 elements") && has(text, "found: 3")) << text;
}

TEST(Vectors, AnIndexBeyondTheEndIsAnError) {
  for (const char* reader : {R"("g": {"type": "Gain", "gain": 1, "in": {"u": "v.y[3]"}})",
                             R"("g": {"type": "Gain", "gain": 1, "in": {"u": "a.y[1]"}})"}) {
    const std::string text = problems_of(with_three(reader));
    EXPECT_TRUE(has(text, "counted from 0")) << text;
  }
  for (const char* wrong : {"v.y[-1]", "v.y[]", "v.y[1", "v.y[x]", "v.y[1][0]", "v.y[123456789012]"})
    EXPECT_NE(problems_of(with_three(
                  fmt::format(R"("g": {{"type": "Gain", "gain": 1, "in": {{"u": "{}"}}}})", wrong))),
              "")
        << wrong;
}

TEST(Vectors, AnInputWithoutAWireReadsItsNumberForEveryElement) {
  // After the reset at 0.5 s both axes are at 0, the default of `reset_value`.
  const auto plan = plan_of(with_three(R"("r": {"type": "Step", "time": 0.5, "sample_time": 0.1},
    "g": {"type": "Gain", "gain": 1, "in": {"u": "v.y"}},
    "m": {"type": "SynchronizedMotion", "sample_time": 0.1, "velocity": [10, 10, 10], "acceleration": [100, 100, 100], "in": {"target": "g.y", "reset": "r.y"}})"));
  for (const Plan::Block& block : plan->blocks)
    if (block.path == "m") {
      EXPECT_EQ(block.inputs[2].size(), 3u);
    }
  const RunResult result = simulate(*plan);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(signal(result, fmt::format("m.position[{}]", i))[4], i + 1, 1e-9) << "at its target before";
    EXPECT_EQ(signal(result, fmt::format("m.position[{}]", i))[5], 0) << i;
  }
}

TEST(Vectors, UnpackBeyondTheEndStopsTheRun) {
  const RunResult result = run_of(with_three(R"("u": {"type": "Unpack", "index": 3, "in": {"u": "v.y"}})"));
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_TRUE(has(result.message, "\"u\"") && has(result.message, "no element of this index"))
      << result.message;
}

TEST(Vectors, AnIndexBeyondTheEndInALogIsAnErrorNotACrash) {
  const std::string text = problems_of(diagram(three, R"("stop": 1)", R"(, "log": ["v.y[3]"])"));
  EXPECT_TRUE(has(text, "counted from 0")) << text;
}

TEST(Vectors, AnIndexBeyondTheEndOfASubdiagramOutputIsAnErrorNotACrash) {
  DiagramFolder folder;
  folder.with("inner.json",
              fmt::format(R"({{"loopwright": 1, "outputs": {{"y": "v.y[7]"}}, "blocks": {{{}}}}})", three));
  folder.with("top.json", diagram(R"("s": {"diagram": "inner.json"})"));
  EXPECT_TRUE(has(problems_in(folder), "counted from 0")) << problems_in(folder);
}

TEST(Vectors, ThatGrowRoundARingAreAnErrorNotAHang) {
  const std::string text = problems_of(diagram(
      R"("a": {"type": "Constant", "value": 1}, "p": {"type": "Pack", "in": {"elements": ["a.y", "d.y"]}},
    "d": {"type": "UnitDelay", "sample_time": 0.1, "in": {"u": "p.y"}})"));
  EXPECT_TRUE(has(text, "grow without end around a cycle")) << text;
}

}  // namespace
}  // namespace loopwright::vectors_test
