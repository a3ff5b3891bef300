// Pictures of diagrams have every wire.
#include <filesystem>
#include <gtest/gtest.h>
#include "engine/json/file_kind.h"
#include "tools/draw/diagram_graph.h"
#include "tools/draw/machine_chart.h"
#include "where.h"

namespace loopwright::diagram_graph_test {
namespace {

using Side = report::GraphEnd::Side;

size_t wires_of(const Diagram& diagram) {
  size_t count = 0;
  for (const BlockEntry& block : diagram.blocks) {
    for (const PortWires& wires : block.in) count += wires.wires.size();
    if (block.subdiagram) count += wires_of(*block.subdiagram);
    count += block.condition != nullptr;
  }
  return count;
}

/// Input ports of nodes that no edge, or more than one, leads to.
std::string faults_of(const report::Graph& graph) {
  std::string faults;
  for (size_t n = 0; n < graph.nodes.size(); ++n)
    for (size_t i = 0; i < graph.nodes[n].inputs.size(); ++i) {
      const auto leads_there = [&](const auto& edge) {
        return edge.to.node == n && edge.to.side == Side::input && edge.to.port == i;
      };
      if (std::ranges::count_if(graph.edges, leads_there) != 1)
        faults += graph.nodes[n].path + "." + graph.nodes[n].inputs[i].name + "\n";
    }
  return faults;
}

TEST(DiagramGraph, HasEveryWireOfEveryShippedDiagram) {
  size_t diagrams = 0, machines = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(LOOPWRIGHT_SOURCE "/diagrams")) {
    const std::string path = entry.path().string();
    Problems problems;
    if (entry.path().extension() != ".json" || kind_of_file(path, problems) != FileKind::diagram) continue;
    const auto diagram = load_diagram(path, {}, problems);
    if (!diagram || !diagram->inputs.empty()) continue;
    const auto plan = compile(*diagram, problems);
    ASSERT_TRUE(plan) << problems.text();
    const report::Graph graph = diagram_graph(*diagram, *plan, 100'000);
    EXPECT_EQ(faults_of(graph), "") << path;
    const auto is_read = [](const auto& edge) { return edge.to.side == Side::input; };
    EXPECT_EQ(size_t(std::ranges::count_if(graph.edges, is_read)), wires_of(*diagram)) << path;
    ++diagrams;
    machines += size_t(std::ranges::count(graph.nodes, "StateMachine", &report::GraphNode::type));
  }
  EXPECT_GT(diagrams, 50u);
  EXPECT_GT(machines, 0u);  // its ports are those that the instance declares
}

TEST(DiagramGraph, AStateMachineHasItsChart) {
  Problems problems;
  const auto diagram = load_diagram(LOOPWRIGHT_SOURCE "/diagrams/examples/state_machine.json",
                                    {.set = {{"speed", "30 mm/s"}}}, problems);
  const auto plan = compile(*diagram, problems);
  ASSERT_TRUE(plan) << problems.text();
  const report::Graph graph = diagram_graph(*diagram, *plan);
  const auto machine = std::ranges::find(graph.nodes, "machine", &report::GraphNode::path);
  EXPECT_EQ(machine->face.text, "6 states");
  EXPECT_EQ(
      report::chart_json(machine->chart),
      R"j({"states":[{"name":"idle","parent":-1,"initial":true,"entries":["velocity = 0 m/s","lamp = 0"]},)j"
      R"j({"name":"running","parent":-1,"initial":false,"entries":["lamp = 1"]},)j"
      R"j({"name":"warming","parent":1,"initial":true,"entries":[]},)j"
      R"j({"name":"forward","parent":1,"initial":false,"entries":["velocity = 30 mm/s"]},)j"
      R"j({"name":"backward","parent":1,"initial":false,"entries":["velocity = -30 mm/s"]},)j"
      R"j({"name":"fault","parent":-1,"initial":false,"entries":["velocity = 0 m/s","lamp = 2"]}],)j"
      R"j("transitions":[{"from":0,"to":1,"guard":"start","order":0},{"from":1,"to":5,"guard":"jam","order":1},)j"
      R"j({"from":1,"to":0,"guard":"after(6 s)","order":2},{"from":2,"to":3,"guard":"after(warm_up)","order":0},)j"
      R"j({"from":3,"to":4,"guard":"position > reach","order":0},)j"
      R"j({"from":4,"to":3,"guard":"position \u003c 0 && after(0.1 s)","order":0},)j"
      R"j({"from":5,"to":0,"guard":"acknowledge && !jam","order":0}]})j");
}

TEST(MachineChart, PrioritiesSortTransitions) {
  const report::GraphChart chart = machine_chart(
      R"([{"name":"a","transitions":[{"to":"b","when":"late","priority":2},{"to":"a","priority":1}]},{"name":"b"}])",
      "[]", "b");
  ASSERT_EQ(chart.transitions.size(), 2u);
  EXPECT_EQ(chart.transitions[0].to, 0u);
  EXPECT_EQ(chart.transitions[0].order, 1);
  EXPECT_EQ(chart.transitions[1].guard, "late");
  EXPECT_FALSE(chart.states[0].is_initial);
  EXPECT_TRUE(chart.states[1].is_initial);
  EXPECT_EQ(report::chart_json({}), "null");
}

}  // namespace
}  // namespace loopwright::diagram_graph_test
