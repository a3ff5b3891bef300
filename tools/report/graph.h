/// A block diagram as data for its drawing: blocks, what they show, wires. Pages and pictures lay it out and
/// draw it with the same scripts (tools/report/page/diagram_*.js).
#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace loopwright::report {

struct GraphPort {
  std::string name;
  std::string unit;  ///< of the signal; "1" or empty: not shown
  std::string sign;  ///< "+", "−", "×", "÷": drawn beside the port; empty: the name is
  int rate = -1;     ///< of the signal: index into Graph::rates; -1: not known
};

/// What a block shows inside. Everything is optional; a block without a face shows its name and type.
struct GraphFace {
  enum class Shape { box, circle, gain };
  Shape shape = Shape::box;
  std::string text;                    ///< "4 N/m", "e⁻ᵀˢ"
  std::string numerator, denominator;  ///< of a fraction
  /// Characteristics: strokes through points (x, y) in [-1, 1]², y upward.
  std::vector<std::vector<std::pair<double, double>>> strokes;
  bool has_axes = false;  ///< lines through x = 0 and y = 0 behind the strokes
};

struct ChartState {
  std::string name;
  int parent = -1;                   ///< the state that contains it; -1: none
  bool is_initial = false;           ///< entered by default with the state that contains it
  std::vector<std::string> entries;  ///< "velocity = 20 mm/s": what it sets when it is entered
};

struct ChartTransition {
  std::size_t from = 0, to = 0;
  std::string guard;  ///< empty: always true
  int order = 0;      ///< 1: the first that is tested of several from this state; 0: it is the only one
};

/// The chart of a state machine (tools/report/page/chart_*.js lay it out and draw it).
struct GraphChart {
  std::vector<ChartState> states;
  std::vector<ChartTransition> transitions;
};

/// One block, or a subdiagram. A path with dots, "stage.friction", stands inside the subdiagram "stage".
struct GraphNode {
  std::string path;
  std::string type;  ///< "ViscousFriction"; of a subdiagram: its title or file
  std::string room;  ///< determines the color: sources, math, continuous, discrete, control, mechanics,
                     ///  sensors, learning, io; "subdiagram"
  std::vector<GraphPort> inputs, outputs;
  GraphFace face;
  std::string details;  ///< effective parameters, one a line, for the pointer
  GraphChart chart{};   ///< of a state machine, which opens as a subdiagram does; without states: it is none
};

/// One end of a wire: a port of a node. Inside a subdiagram its inputs are sources, its outputs readers.
struct GraphEnd {
  enum class Side { input, output };
  std::size_t node = 0;
  Side side = Side::output;
  std::size_t port = 0;
  bool operator==(const GraphEnd&) const = default;
};

/// Both ends are at the same level: ports of neighbours, or one of the subdiagram around the other.
struct GraphEdge {
  GraphEnd from, to;
};

struct Graph {
  std::string caption;
  std::vector<std::string> rates;  ///< for the legend: "continuous", "1 ms", "constant"; fastest first
  std::vector<GraphNode> nodes;    ///< a subdiagram before its blocks
  std::vector<GraphEdge> edges;
};

/// A chart as JSON for the scripts: {"states": [{"name", "parent", "initial", "entries"}], "transitions":
/// [{"from", "to", "guard", "order"}]}; null without states.
std::string chart_json(const GraphChart& chart);

/// The graph as JSON for the scripts; harmless inside a <script> element.
std::string graph_json(const Graph& graph);

/// The wires, one per line: "reference.position → feedback.reference  m". Blocks without wires follow.
std::string graph_text(const Graph& graph);

/// Whether a node stands inside a subdiagram, at any depth.
bool is_inside(const GraphNode& node, const GraphNode& subdiagram);

/// The same diagram without what is deeper than `depth`: at 0 every subdiagram is a block.
Graph down_to(const Graph& graph, std::size_t depth);

}  // namespace loopwright::report
