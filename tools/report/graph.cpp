#include "tools/report/graph.h"
#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include "tools/report/typography.h"

namespace loopwright::report {
namespace {

std::string ports_json(const std::vector<GraphPort>& ports) {
  std::string out = "[";
  for (const GraphPort& port : ports)
    fmt::format_to(std::back_inserter(out), R"({}{{"name":{},"unit":{},"sign":{},"rate":{}}})",
                   out.size() > 1 ? "," : "", json_string(port.name), json_string(readable_unit(port.unit)),
                   json_string(port.sign), port.rate);
  return out + ']';
}

std::string face_json(const GraphFace& face) {
  static constexpr std::string_view shapes[] = {"box", "circle", "gain"};
  std::string strokes = "[";
  for (const auto& stroke : face.strokes) {
    strokes += strokes.size() > 1 ? ",[" : "[";
    for (const auto& [x, y] : stroke)
      fmt::format_to(std::back_inserter(strokes), "{}[{:.3g},{:.3g}]", strokes.back() == '[' ? "" : ",", x,
                     y);
    strokes += ']';
  }
  return fmt::format(R"({{"shape":"{}","text":{},"numerator":{},"denominator":{},"strokes":{}],"axes":{}}})",
                     shapes[std::size_t(face.shape)], json_string(face.text), json_string(face.numerator),
                     json_string(face.denominator), strokes, face.has_axes);
}

std::string end_json(const GraphEnd& end) {
  return fmt::format(R"([{},"{}",{}])", end.node, end.side == GraphEnd::Side::input ? "i" : "o", end.port);
}

std::string end_text(const Graph& graph, const GraphEnd& end) {
  const GraphNode& node = graph.nodes[end.node];
  const auto& ports = end.side == GraphEnd::Side::input ? node.inputs : node.outputs;
  return node.path + '.' + ports[end.port].name;
}

std::size_t depth_of(const GraphNode& node) {
  return std::size_t(std::count(node.path.begin(), node.path.end(), '.'));
}

}  // namespace

std::string chart_json(const GraphChart& chart) {
  if (chart.states.empty()) return "null";
  std::string out = "{\"states\":[";
  const auto separate = [&] {
    if (out.back() != '[') out += ',';
  };
  for (const ChartState& state : chart.states) {
    separate(), out += fmt::format(R"({{"name":{},"parent":{},"initial":{},"entries":[)",
                                   json_string(state.name), state.parent, state.is_initial);
    for (const std::string& entry : state.entries) separate(), out += json_string(entry);
    out += "]}";
  }
  out += "],\"transitions\":[";
  for (const ChartTransition& transition : chart.transitions)
    separate(), out += fmt::format(R"({{"from":{},"to":{},"guard":{},"order":{}}})", transition.from,
                                   transition.to, json_string(transition.guard), transition.order);
  return out + "]}";
}

bool is_inside(const GraphNode& node, const GraphNode& subdiagram) {
  return node.path.size() > subdiagram.path.size() && node.path.starts_with(subdiagram.path) &&
         node.path[subdiagram.path.size()] == '.';
}

std::string graph_json(const Graph& graph) {
  std::string out = fmt::format(R"({{"caption":{},"rates":[)", json_string(graph.caption));
  const auto separate = [&] {
    if (out.back() != '[') out += ',';
  };
  for (const std::string& rate : graph.rates) separate(), out += json_string(rate);
  out += "],\"nodes\":[";
  for (const GraphNode& node : graph.nodes)
    separate(),
        fmt::format_to(
            std::back_inserter(out),
            R"({{"path":{},"type":{},"room":{},"inputs":{},"outputs":{},"face":{},"details":{},"chart":{}}})",
            json_string(node.path), json_string(node.type), json_string(node.room), ports_json(node.inputs),
            ports_json(node.outputs), face_json(node.face), json_string(node.details),
            chart_json(node.chart));
  out += "],\n\"edges\":[";
  for (const GraphEdge& edge : graph.edges)
    separate(), out += fmt::format("[{},{}]", end_json(edge.from), end_json(edge.to));
  return out + "]}";
}

std::string graph_text(const Graph& graph) {
  std::string out;
  std::vector<bool> wired(graph.nodes.size());
  for (const GraphEdge& edge : graph.edges) {
    wired[edge.from.node] = wired[edge.to.node] = true;
    out += fmt::format("{} → {}", end_text(graph, edge.from), end_text(graph, edge.to));
    const GraphNode& source = graph.nodes[edge.from.node];
    const auto& ports = edge.from.side == GraphEnd::Side::input ? source.inputs : source.outputs;
    const std::string unit = readable_unit(ports[edge.from.port].unit);
    out += unit.empty() ? "\n" : "  " + unit + '\n';
  }
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    if (!wired[i]) out += graph.nodes[i].path + '\n';
  return out;
}

Graph down_to(const Graph& graph, std::size_t depth) {
  Graph kept{graph.caption, graph.rates, {}, {}};
  std::vector<std::size_t> place(graph.nodes.size());
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    if (depth_of(graph.nodes[i]) <= depth) {
      place[i] = kept.nodes.size();
      kept.nodes.push_back(graph.nodes[i]);
    }
  // A wire at an inner side of a subdiagram lies one level deeper than it.
  const auto is_kept = [&](const GraphEnd& end, GraphEnd::Side inner) {
    return depth_of(graph.nodes[end.node]) + (end.side == inner ? 1 : 0) <= depth;
  };
  for (GraphEdge edge : graph.edges)
    if (is_kept(edge.from, GraphEnd::Side::input) && is_kept(edge.to, GraphEnd::Side::output)) {
      edge.from.node = place[edge.from.node], edge.to.node = place[edge.to.node];
      kept.edges.push_back(edge);
    }
  return kept;
}

}  // namespace loopwright::report
