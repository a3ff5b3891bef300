// The contents of the page and the summary of a run.
#include <gtest/gtest.h>
#include "tests/engine/written_diagram.h"
#include "tests/tools/report/well_formed.h"
#include "engine/plan/load.h"
#include "tools/draw/diagram_graph.h"
#include "tools/run/judged_run.h"
#include "tools/run/run_page.h"

namespace loopwright::run_page_test {
namespace {

constexpr std::string_view blocks =
    R"("reference": {"type": "Step", "time": 0.2, "after": {"value": 1, "unit": "m"}},
  "error": {"type": "Sum", "sample_time": 0.1, "signs": "+-", "in": {"terms": ["reference.y", "stage.position"]}},
  "gain": {"type": "Gain", "gain": {"value": 4, "unit": "N/m"}, "in": {"u": "error.sum"}}, "stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "in": {"force": "gain.y"}},
  "relay": {"type": "Relay", "switch_on": {"value": 0.5, "unit": "m"}, "switch_off": {"value": 0.1, "unit": "m"}, "in": {"u": "stage.position"}})";
constexpr std::string_view dopri = R"("stop": 3, "method": "dopri5", "record_step": 0.05)";

/// The page of a run as the command makes it.
std::string page_of(const LoadedDiagram& loaded) {
  const auto [result, figures] = run_and_judge(loaded.diagram.get(), *loaded.plan);
  return report::to_html(run_page(loaded.diagram.get(), *loaded.plan, result, figures));
}

LoadedDiagram loaded(std::string_view text) {
  static DiagramFolder folder;
  return load_diagram_and_plan(folder.with("top.json", text).path("top.json"));
}

TEST(RunPage, HasOutcomeSignalsDiagramSolverAndParameters) {
  const std::string html = page_of(loaded(diagram(blocks, dopri, R"(, "title": "A <small> servo")")));
  EXPECT_EQ(report::fault_in_html(html), "");
  for (const char* part :
       {"A &lt;small&gt; servo", "stage.position follows reference.y", "a guess from the wires",
        "Restarts after samples and events", "Events of relay.threshold", "gain.gain", "4 "})
    EXPECT_TRUE(has(html, part)) << part;
  EXPECT_FALSE(has(html, "A <small>")) << "what a file says is text, not markup";
}

TEST(RunPage, OfAFailedRunSaysWhy) {
  EXPECT_TRUE(has(
      page_of(loaded(diagram(
          R"("x": {"type": "Integrator", "initial": 1, "in": {"u": "p.product"}}, "p": {"type": "Product", "in": {"factors": ["x.y", "x.y"]}})",
          R"("stop": 10, "step": 0.01)"))),
      "The run failed: the run diverged"));
}

TEST(DiagramGraph, HasABlockForEachAWireForEachReaderAndWhatTheyShow) {
  const LoadedDiagram servo = loaded(diagram(blocks, dopri));
  const report::Graph graph = diagram_graph(*servo.diagram, *servo.plan);
  EXPECT_EQ(graph.nodes.size(), 5u);
  ASSERT_EQ(graph.edges.size(), 5u);
  const std::string wires = report::graph_text(graph);
  EXPECT_TRUE(has(wires, "gain.y → stage.force  N\n")) << wires;
  EXPECT_TRUE(has(wires, "stage.position → error.terms[1]  m\n")) << wires;
  EXPECT_EQ(graph.rates, (std::vector<std::string>{"continuous", "100 ms"}));
  const auto node = [&](std::string_view path) {
    return *std::ranges::find(graph.nodes, path, &report::GraphNode::path);
  };
  EXPECT_EQ(node("gain").face.text, "4\u202FN/m");
  EXPECT_EQ(node("error").inputs[0].sign + node("error").inputs[1].sign, "+−");
  EXPECT_EQ(node("stage").face.denominator, "m s²");
  EXPECT_FALSE(node("relay").face.strokes.empty());
  EXPECT_EQ(graph.rates[size_t(node("error").outputs[0].rate)], "100 ms");
}

TEST(RunSummary, ShowsHowItEndedAndEverySignal) {
  const auto plan = plan_of(diagram(blocks, dopri));
  const std::string text = run_summary(*plan, simulate(*plan), {});
  EXPECT_TRUE(text.starts_with("done: 3 of 3 s")) << text;
  for (const char* name : {"reference.y", "error.sum", "gain.y", "stage.position", "relay.y"})
    EXPECT_TRUE(has(text, name)) << name << text;
}

TEST(RunSummary, OfNoRowsIsNoCrash) {
  const auto plan = plan_of(diagram(
      R"("e": {"type": "Expression", "formula": "ln(-1) + c", "names": ["c"], "in": {"arguments": ["c.y"]}}, "c": {"type": "Constant", "value": 1})"));
  const RunResult result = simulate(*plan);
  EXPECT_EQ(result.recording.rows(), 0u);
  EXPECT_TRUE(has(run_summary(*plan, result, {}), "failed: 0 of 1 s"));
  EXPECT_TRUE(has(report::to_html(run_page(nullptr, *plan, result, {})), "The run failed"));
}

}  // namespace
}  // namespace loopwright::run_page_test
