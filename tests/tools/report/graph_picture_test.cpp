#include "tools/report/graph_picture.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "tests/tools/report/sample_page.h"
#include "tests/tools/report/well_formed.h"
#include "tools/report/child_process.h"

namespace loopwright::report::graph_picture_test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

size_t count(std::string_view text, std::string_view part) {
  size_t found = 0;
  for (size_t at = 0; (at = text.find(part, at)) != text.npos; ++at) ++found;
  return found;
}

bool is_there(const std::string& program) {
  return run_program({"sh", "-c", "command -v " + program}, "", 20s).succeeded;
}

/// Left edge of the rectangle of a block, whose title begins with its path.
double left_of(const std::string& svg, const std::string& path) {
  const size_t node = svg.find("<title>" + path + "  (");
  EXPECT_NE(node, svg.npos) << path;
  return std::strtod(svg.c_str() + svg.find(" x=\"", node) + 4, nullptr);
}

TEST(GraphPicture, ShowsBlocksSubdiagramsAndWiresFromLeftToRight) {
  if (!is_there("node")) GTEST_SKIP() << "node is not installed";
  const GraphPicture picture = draw_svg(servo_graph());
  ASSERT_EQ(picture.failure, "");
  const std::string& svg = picture.bytes;
  EXPECT_EQ(fault_in_html(svg), "");
  for (const std::string_view text :
       {">feedback</text>", ">PdController</text>", ">friction</text>", ">stage</text>",
        "class=\"node mechanics\"", "class=\"frame\"", "reference.position (m) → feedback.reference",
        ">1 ms</text>", ">m s²</text>"})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_EQ(count(svg, "<g class=\"wire "), servo_graph().edges.size() + 1) << "and one line in the legend";
  EXPECT_LT(left_of(svg, "reference"), left_of(svg, "feedback"));
  EXPECT_LT(left_of(svg, "feedback"), left_of(svg, "command"));
  EXPECT_LT(left_of(svg, "command"), left_of(svg, "stage.motor"));
  EXPECT_LT(left_of(svg, "stage.motor"), left_of(svg, "stage.mass"));
  EXPECT_LT(left_of(svg, "stage.mass"), left_of(svg, "encoder"));
}

TEST(GraphPicture, StandsAloneWithItsColors) {
  if (!is_there("node")) GTEST_SKIP() << "node is not installed";
  const std::string svg = draw_svg(servo_graph()).bytes;
  EXPECT_THAT(svg, Not(HasSubstr("var(")));
  EXPECT_THAT(svg, HasSubstr("fill: #fbe5de")) << "the color of controllers";
  EXPECT_THAT(svg, Not(HasSubstr("<script")));
}

TEST(GraphPicture, ClosesSubdiagramsBelowADepth) {
  if (!is_there("node")) GTEST_SKIP() << "node is not installed";
  const std::string svg = draw_svg(servo_graph(), {.depth = 0}).bytes;
  EXPECT_THAT(svg, HasSubstr(">stage</text>"));
  EXPECT_THAT(svg, Not(HasSubstr(">friction</text>")));
}

TEST(GraphPicture, DrawsTheChartOfAStateMachineInsideItsBlock) {
  if (!is_there("node")) GTEST_SKIP() << "node is not installed";
  Graph graph{
      "",
      {"1 ms"},
      {{"machine", "StateMachine", "logic", {{"switch", "", "", -1}}, {{"state", "", "", 0}}, {}, {}}},
      {}};
  graph.nodes[0].face.text = "3 states";
  graph.nodes[0].chart = {{{"off", -1, true, {}}, {"on", -1, false, {"servo = 1"}}, {"search", 1, true, {}}},
                          {{0, 1, "switch && after(0.5 s)", 0}, {2, 0, "", 0}}};
  const std::string open = draw_svg(graph).bytes, closed = draw_svg(graph, {.depth = 0}).bytes;
  EXPECT_EQ(fault_in_html(open), "");
  EXPECT_EQ(count(open, "<g class=\"state"), 3u);
  EXPECT_EQ(count(open, "class=\"state outer\""), 1u);
  EXPECT_EQ(count(open, "<circle class=\"initial\""), 2u)
      << "of the machine, and of the state that contains another";
  EXPECT_EQ(count(open, "<g class=\"transition\">"), 4u) << "two of them by default";
  for (const std::string_view text :
       {">servo = 1</text>", ">switch &amp;&amp; after(0.5 s)</text>", ">always</text>"})
    EXPECT_THAT(open, HasSubstr(text));
  EXPECT_THAT(open, Not(HasSubstr("3 states")));
  EXPECT_THAT(closed, HasSubstr(">3 states</text>"));
  EXPECT_THAT(closed, Not(HasSubstr("class=\"state\"")));
}

TEST(GraphPicture, NamesOfAnyKindAreHarmless) {
  if (!is_there("node")) GTEST_SKIP() << "node is not installed";
  const std::string evil = "a\"]; b -> c </script><script>alert(1)</script>\\";
  Graph graph{
      evil, {evil}, {{evil, evil, evil, {{evil, evil, evil, 0}}, {{evil, evil, evil, 0}}, {}, evil}}, {}};
  graph.edges = {{{0, GraphEnd::Side::output, 0}, {0, GraphEnd::Side::input, 0}}};
  const GraphPicture picture = draw_svg(graph);
  ASSERT_EQ(picture.failure, "");
  EXPECT_THAT(picture.bytes, Not(HasSubstr("<script")));
  EXPECT_EQ(fault_in_html(picture.bytes), "");
  EXPECT_THAT(graph_json(graph), Not(HasSubstr("</script")));
}

TEST(GraphPicture, ABrowserDrawsTheSameAsNode) {
  if (!is_there("node") || !is_there("chromium")) GTEST_SKIP() << "node or chromium is not installed";
  const GraphPicture picture = draw_svg(servo_graph(), {.interpreters = {"chromium"}});
  EXPECT_EQ(picture.failure, "");
  EXPECT_EQ(picture.bytes, draw_svg(servo_graph()).bytes);
}

TEST(GraphPicture, WithoutAProgramSaysWhatToInstall) {
  const GraphPicture picture =
      draw_svg(servo_graph(), {.interpreters = {"no-such-program-as-this", "false"}});
  EXPECT_EQ(picture.bytes, "");
  EXPECT_THAT(picture.failure, HasSubstr("Debian packages nodejs, chromium"));
  EXPECT_THAT(picture.failure,
              HasSubstr("no-such-program-as-this could not be started: No such file or directory"));
  EXPECT_THAT(picture.failure, HasSubstr("false ended with code 1"));
}

TEST(Graph, DownToADepthKeepsWiresBetweenTheRest) {
  const Graph top = down_to(servo_graph(), 0);
  EXPECT_EQ(top.nodes.size(), 7u);
  EXPECT_EQ(top.edges.size(), 11u);
  EXPECT_THAT(graph_text(top), HasSubstr("stage.position → encoder.position  m\n"));
  EXPECT_THAT(graph_text(top), Not(HasSubstr("friction")));
}

TEST(Graph, AnEmptyDiagramIsDrawn) {
  if (!is_there("node")) GTEST_SKIP() << "node is not installed";
  EXPECT_EQ(draw_svg({}).failure, "");
}

TEST(RunProgram, PassesInputAndOutputOfAnySize) {
  const std::string text(3'000'000, 'x');
  const ChildResult result = run_program({"cat"}, text, 20s);
  EXPECT_TRUE(result.succeeded) << result.failure;
  EXPECT_EQ(result.output, text);
}

TEST(RunProgram, EndsAProgramThatTakesTooLong) {
  const auto start = std::chrono::steady_clock::now();
  const ChildResult result = run_program({"sleep", "30"}, "", 100ms);
  EXPECT_FALSE(result.succeeded);
  EXPECT_EQ(result.failure, "sleep took longer than 0.1 s");
  EXPECT_LT(std::chrono::steady_clock::now() - start, 10s);
}

TEST(RunProgram, TellsWhatTheProgramComplainedAbout) {
  EXPECT_THAT(run_program({"cat", "/no/such/file"}, "", 20s).failure,
              MatchesRegex("cat ended with code 1: .*No such file.*"));
}

}  // namespace
}  // namespace loopwright::report::graph_picture_test
