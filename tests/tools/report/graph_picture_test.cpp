#include "tools/report/graph_picture.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "tests/tools/report/sample_page.h"
#include "tests/tools/report/well_formed.h"
#include "tools/report/child_process.h"

namespace loopwright::report {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

Graph chain(size_t frames, size_t blocks_in_each) {
  Graph graph{"Chain", {}, {}};
  for (size_t f = 0; f < frames; ++f)
    for (size_t b = 0; b < blocks_in_each; ++b) {
      const std::string path = "axis" + std::to_string(f) + ".block" + std::to_string(b);
      if (!graph.nodes.empty()) graph.edges.push_back({graph.nodes.back().path, "out", path, "in", "", "m"});
      graph.nodes.push_back({path, "Gain", "math", {"in"}, {"out"}});
    }
  return graph;
}

TEST(GraphPicture, ShowsBlocksFramesAndWires) {
  const auto items = graph_picture(servo_graph());
  ASSERT_EQ(items.size(), 1u);
  ASSERT_TRUE(std::holds_alternative<Picture>(items[0]));
  const std::string& svg = std::get<Picture>(items[0]).svg;
  EXPECT_EQ(fault_in_html(svg), "");
  for (const std::string_view text :
       {">feedback</text>", ">PdController</text>", ">friction</text>", ">stage</text>",
        "class=\"node mechanics\"", "class=\"cluster\"", "reference.position (m) → feedback.reference"})
    EXPECT_THAT(svg, HasSubstr(text));
  size_t wires = 0;
  for (size_t at = 0; (at = svg.find("class=\"edge\"", at)) != svg.npos; ++at) ++wires;
  EXPECT_EQ(wires, servo_graph().edges.size());
}

TEST(GraphPicture, TakesFontsFromThePageAndSharesNoNamesWithOtherPictures) {
  const auto items = graph_picture(servo_graph());
  const std::string& svg = std::get<Picture>(items.at(0)).svg;
  EXPECT_THAT(svg, Not(HasSubstr("font-family")));
  EXPECT_THAT(svg, Not(HasSubstr(" id=")));
  EXPECT_THAT(svg, Not(HasSubstr("<?xml")));
  EXPECT_THAT(svg, Not(HasSubstr("<!")));
}

TEST(GraphPicture, NamesOfAnyKindAreHarmless) {
  const std::string evil = "a\"]; b -> c </script><script>alert(1)</script>\\";
  const Graph graph{evil,
                    {{evil, evil, evil, {evil}, {evil}}, {"b", "", "", {}, {}}},
                    {{evil, evil, "b", evil, evil, evil}}};
  const auto items = graph_picture(graph);
  ASSERT_TRUE(std::holds_alternative<Picture>(items.at(0)));
  const std::string& svg = std::get<Picture>(items[0]).svg;
  EXPECT_THAT(svg, Not(HasSubstr("<script")));
  EXPECT_EQ(fault_in_html(svg), "");
}

TEST(GraphPicture, DrawsManyBlocksWithSubdiagramsClosed) {
  const auto items = graph_picture(chain(10, 31));
  ASSERT_EQ(items.size(), 2u);
  const std::string& svg = std::get<Picture>(items[0]).svg;
  EXPECT_THAT(svg, HasSubstr(">axis9</text>"));
  EXPECT_THAT(svg, HasSubstr(">31 blocks</text>"));
  EXPECT_THAT(svg, Not(HasSubstr("block30")));
  EXPECT_THAT(std::get<Notice>(items[1]).text, HasSubstr("310 blocks"));
}

TEST(GraphPicture, ClosingMergesWiresAndKeepsLoopsOfSingleBlocks) {
  Graph graph = chain(2, 3);
  graph.nodes.push_back({"gain", "Gain", "math", {"in"}, {"out"}});
  graph.edges.push_back({"axis1.block0", "out", "gain", "in", "", ""});
  graph.edges.push_back({"axis1.block2", "out", "gain", "in", "", ""});
  graph.edges.push_back({"gain", "out", "gain", "in", "", ""});
  const Graph closed = with_closed_subdiagrams(graph);
  EXPECT_EQ(graph_text(closed), "axis0 → axis1\naxis1 → gain\ngain → gain\n");
  ASSERT_EQ(closed.nodes.size(), 3u);
  EXPECT_EQ(closed.nodes[2].type, "Gain");
}

TEST(GraphPicture, WithoutDotTheWiresAreListed) {
  GraphOptions options;
  options.program = "no-such-program-as-this";
  const auto items = graph_picture(chain(1, 2), options);
  ASSERT_EQ(items.size(), 2u);
  EXPECT_THAT(std::get<Notice>(items[0]).text,
              HasSubstr("no-such-program-as-this could not be started: No such file or directory"));
  EXPECT_EQ(std::get<Code>(items[1]).text, "axis0.block0.out → axis0.block1.in  m\n");
}

TEST(GraphPicture, ADotThatFailsOrSaysNothingIsReported) {
  GraphOptions options;
  options.program = "false";
  EXPECT_THAT(std::get<Notice>(graph_picture(chain(1, 2), options).at(0)).text,
              HasSubstr("false ended with code 1"));
  options.program = "true";
  EXPECT_THAT(std::get<Notice>(graph_picture(chain(1, 2), options).at(0)).text,
              HasSubstr("true gave no picture"));
}

TEST(GraphPicture, AnEmptyDiagramIsDrawn) {
  EXPECT_TRUE(std::holds_alternative<Picture>(graph_picture({}).at(0)));
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
}  // namespace loopwright::report
