/// A block diagram as a picture, laid out by the program `dot` of Graphviz.
#pragma once
#include <chrono>
#include <string>
#include <vector>
#include "tools/report/report.h"

namespace loopwright::report {

/// One block. A path with dots, "stage.friction", places it in the frame "stage".
struct GraphNode {
  std::string path;
  std::string type;  ///< "ViscousFriction"
  std::string room;  ///< determines the color: sources, math, continuous, discrete, control, mechanics,
                     ///  sensors, learning, io
  std::vector<std::string> inputs, outputs;  ///< names of ports, drawn on the left and right
};

/// One wire, from an output port to an input port. Edges whose nodes are not in the graph are ignored.
struct GraphEdge {
  std::string from, from_port;  ///< path of a node, name of its output
  std::string to, to_port;
  std::string label;  ///< written beside the wire; empty: none
  std::string unit;   ///< of the signal; shown with the label, and alone when the pointer is on the wire
};

struct Graph {
  std::string caption;
  std::vector<GraphNode> nodes;
  std::vector<GraphEdge> edges;
};

struct GraphOptions {
  std::string program = "dot";
  std::chrono::milliseconds time_limit{10'000};
  std::size_t most_nodes = 300;  ///< above it, subdiagrams are drawn closed
};

/// The picture, followed or replaced by notices: subdiagrams drawn closed because of their number, or no
/// picture because dot is absent, fails or takes too long (then the wires are listed as text). Never throws
/// in these cases.
std::vector<Item> graph_picture(const Graph& graph, const GraphOptions& options = {});

/// The same diagram with one node in place of each top-level subdiagram; wires within one are omitted,
/// parallel ones merged.
Graph with_closed_subdiagrams(const Graph& graph);

/// The wires, one per line: "reference.position → feedback.reference  m". Blocks without wires follow.
std::string graph_text(const Graph& graph);

/// Source text for dot.
std::string graph_source(const Graph& graph);

}  // namespace loopwright::report
