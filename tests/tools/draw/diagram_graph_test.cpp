// Pictures of diagrams have every wire.
#include <filesystem>
#include <gtest/gtest.h>
#include "engine/json/file_kind.h"
#include "tools/draw/diagram_graph.h"
#include "where.h"

namespace loopwright {
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

}  // namespace
}  // namespace loopwright
