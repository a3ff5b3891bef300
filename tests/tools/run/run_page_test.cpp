// The contents of the page and the summary of a run.
#include <gtest/gtest.h>
#include "tests/engine/written_diagram.h"
#include "tests/tools/report/well_formed.h"
#include "tools/run/run_page.h"

namespace loopwright {
namespace {

constexpr std::string_view blocks =
    R"("reference": {"type": "Step", "time": 0.2, "after": {"value": 1, "unit": "m"}},
  "error": {"type": "Sum", "sample_time": 0.1, "signs": "+-", "in": {"terms": ["reference.y", "stage.position"]}},
  "gain": {"type": "Gain", "gain": {"value": 4, "unit": "N/m"}, "in": {"u": "error.sum"}}, "stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "in": {"force": "gain.y"}},
  "relay": {"type": "Relay", "switch_on": {"value": 0.5, "unit": "m"}, "switch_off": {"value": 0.1, "unit": "m"}, "in": {"u": "stage.position"}})";
constexpr std::string_view dopri = R"("stop": 3, "method": "dopri5", "record_step": 0.05)";

TEST(RunPage, HasOutcomeSignalsDiagramSolverAndParameters) {
  const auto plan = plan_of(diagram(blocks, dopri, R"(, "title": "A <small> servo")"));
  const std::string html = report::to_html(run_page(*plan, simulate(*plan)));
  EXPECT_EQ(report::fault_in_html(html), "");
  for (const char* part :
       {"A &lt;small&gt; servo", "The run reached its stop time, 3 s.", "stage.position",
        "Restarts after samples and events", "Events of relay.threshold", "gain.gain", "4 "})
    EXPECT_TRUE(has(html, part)) << part;
  EXPECT_FALSE(has(html, "A <small>")) << "what a file says is text, not markup";
}

TEST(RunPage, OfAFailedRunSaysWhy) {
  const auto plan = plan_of(diagram(
      R"("x": {"type": "Integrator", "initial": 1, "in": {"u": "p.product"}}, "p": {"type": "Product", "in": {"factors": ["x.y", "x.y"]}})",
      R"("stop": 10, "step": 0.01)"));
  EXPECT_TRUE(has(report::to_html(run_page(*plan, simulate(*plan))), "The run failed: the run diverged"));
}

TEST(RunPage, TheGraphHasABlockForEachAndAWireForEachReader) {
  const report::Graph graph = graph_of(*plan_of(diagram(blocks, dopri)));
  EXPECT_EQ(graph.nodes.size(), 5u);
  ASSERT_EQ(graph.edges.size(), 5u);
  bool found = false;
  for (const report::GraphEdge& edge : graph.edges)
    found |= edge.from == "gain" && edge.from_port == "y" && edge.to == "stage" && edge.to_port == "force" &&
             edge.unit == "N";
  EXPECT_TRUE(found);
}

TEST(RunSummary, ShowsHowItEndedAndEverySignal) {
  const auto plan = plan_of(diagram(blocks, dopri));
  const std::string text = run_summary(*plan, simulate(*plan));
  EXPECT_TRUE(text.starts_with("done: 3 of 3 s")) << text;
  for (const char* name : {"reference.y", "error.sum", "gain.y", "stage.position", "relay.y"})
    EXPECT_TRUE(has(text, name)) << name << text;
}

TEST(RunSummary, OfNoRowsIsNoCrash) {
  const auto plan = plan_of(diagram(
      R"("e": {"type": "Expression", "formula": "ln(-1) + c", "names": ["c"], "in": {"arguments": ["c.y"]}}, "c": {"type": "Constant", "value": 1})"));
  const RunResult result = simulate(*plan);
  EXPECT_EQ(result.recording.rows(), 0u);
  EXPECT_TRUE(has(run_summary(*plan, result), "failed: 0 of 1 s"));
  EXPECT_TRUE(has(report::to_html(run_page(*plan, result)), "The run failed"));
}

}  // namespace
}  // namespace loopwright
