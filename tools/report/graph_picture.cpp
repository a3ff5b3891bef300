#include "tools/report/graph_picture.h"
#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include "tools/report/child_process.h"
#include "tools/report/typography.h"

namespace loopwright::report {
namespace {

std::string_view top_name(std::string_view path) { return path.substr(0, path.find('.')); }

std::string_view last_name(std::string_view path) { return path.substr(path.rfind('.') + 1); }

/// A quoted string of the dot language.
std::string dot_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// A room as the name of a CSS class: letters only.
std::string css_class(std::string_view room) {
  std::string out;
  std::copy_if(room.begin(), room.end(), std::back_inserter(out),
               [](char c) { return c >= 'a' && c <= 'z'; });
  return out;
}

/// The ports of one side as a column of a table, each cell an anchor for wires.
std::string port_column(const std::vector<std::string>& ports, char side) {
  std::string out = "<TD><TABLE BORDER=\"0\" CELLBORDER=\"0\" CELLSPACING=\"0\" CELLPADDING=\"2\">";
  for (std::size_t i = 0; i < ports.size(); ++i)
    out += fmt::format("<TR><TD PORT=\"{}{}\" ALIGN=\"{}\"><FONT POINT-SIZE=\"9\">{}</FONT></TD></TR>", side,
                       i, side == 'i' ? "LEFT" : "RIGHT", escape_html(ports[i]));
  if (ports.empty()) out += "<TR><TD></TD></TR>";
  return out + "</TABLE></TD>";
}

std::string node_source(const GraphNode& node) {
  std::string label = fmt::format(
      "<TABLE BORDER=\"0\" CELLBORDER=\"0\" CELLSPACING=\"0\" CELLPADDING=\"1\">"
      "<TR><TD COLSPAN=\"3\"><B>{}</B></TD></TR>",
      escape_html(last_name(node.path)));
  if (!node.type.empty())
    label += fmt::format("<TR><TD COLSPAN=\"3\"><FONT POINT-SIZE=\"9\">{}</FONT></TD></TR>",
                         escape_html(node.type));
  if (!node.inputs.empty() || !node.outputs.empty())
    label += "<TR>" + port_column(node.inputs, 'i') + "<TD WIDTH=\"8\"></TD>" +
             port_column(node.outputs, 'o') + "</TR>";
  return fmt::format("{} [class=\"{}\", label=<{}</TABLE>>];\n", dot_string(node.path), css_class(node.room),
                     label);
}

/// End point of a wire at a block: ":i0:w" for the first input. Empty when the block does not list the port.
std::string anchor(const std::vector<std::string>& ports, const std::string& port, char side) {
  const auto found = std::find(ports.begin(), ports.end(), port);
  if (found == ports.end()) return {};
  return fmt::format(":{}{}:{}", side, found - ports.begin(), side == 'i' ? 'w' : 'e');
}

std::string end_text(const std::string& path, const std::string& port) {
  return port.empty() ? path : path + '.' + port;
}

using NodesByPath = std::map<std::string, const GraphNode*, std::less<>>;

NodesByPath nodes_by_path(const Graph& graph) {
  NodesByPath nodes;
  for (const GraphNode& node : graph.nodes) nodes.emplace(node.path, &node);
  return nodes;
}

std::string edge_source(const GraphEdge& edge, const NodesByPath& nodes) {
  const auto from = nodes.find(edge.from), to = nodes.find(edge.to);
  if (from == nodes.end() || to == nodes.end()) return {};
  const std::string tooltip = fmt::format(
      "{} → {}", with_unit(end_text(edge.from, edge.from_port), edge.unit), end_text(edge.to, edge.to_port));
  const std::string label = edge.label.empty() ? "" : with_unit(edge.label, edge.unit);
  return fmt::format("{}{} -> {}{} [tooltip={}, label={}];\n", dot_string(edge.from),
                     anchor(from->second->outputs, edge.from_port, 'o'), dot_string(edge.to),
                     anchor(to->second->inputs, edge.to_port, 'i'), dot_string(tooltip), dot_string(label));
}

/// A frame and its contents, by name.
struct Frame {
  std::map<std::string, Frame> frames;
  std::vector<const GraphNode*> nodes;
};

Frame frames_of(const Graph& graph) {
  Frame root;
  for (const GraphNode& node : graph.nodes) {
    Frame* frame = &root;
    std::string_view rest = node.path;
    for (std::size_t dot; (dot = rest.find('.')) != rest.npos; rest.remove_prefix(dot + 1))
      frame = &frame->frames[std::string(rest.substr(0, dot))];
    frame->nodes.push_back(&node);
  }
  return root;
}

void append_frame(const Frame& frame, std::string& out, int& count) {
  for (const GraphNode* node : frame.nodes) out += node_source(*node);
  for (const auto& [name, inner] : frame.frames) {
    out += fmt::format("subgraph cluster_{} {{ label={}; tooltip={}; margin=12;\n", count++, dot_string(name),
                       dot_string(name));
    append_frame(inner, out, count);
    out += "}\n";
  }
}

/// Removes every ` name="…"` from an SVG text.
void remove_attribute(std::string& svg, std::string_view name) {
  const std::string start = fmt::format(" {}=\"", name);
  for (std::size_t begin = 0; (begin = svg.find(start, begin)) != svg.npos;) {
    const std::size_t end = svg.find('"', begin + start.size());
    if (end == svg.npos) return;
    svg.erase(begin, end + 1 - begin);
  }
}

/// The output of dot prepared for a page: without prologue, comments, and names that two pictures would
/// share; fonts inherited.
std::string for_page(std::string svg) {
  svg.erase(0, svg.find("<svg"));
  for (std::size_t begin; (begin = svg.find("<!--")) != svg.npos;) {
    const std::size_t end = svg.find("-->", begin);
    svg.erase(begin, end == svg.npos ? svg.npos : end + 3 - begin);
  }
  for (const std::string_view name : {"id", "font-family", "xlink:href"}) remove_attribute(svg, name);
  // A wide picture shrinks to the page, but at most to half of its size; beyond that it scrolls.
  const std::size_t width = svg.find("width=\"") + 7;
  const double points = std::strtod(svg.c_str() + width, nullptr);
  svg.insert(4, fmt::format(" class=\"diagram\" role=\"img\" style=\"min-width:{:.0f}pt\"", 0.5 * points));
  return svg;
}

std::vector<Item> fallback(const Graph& graph, const std::string& reason) {
  Notice notice{
      Notice::Severity::warning,
      fmt::format("The block diagram could not be drawn: {}. The picture needs the program dot of Graphviz "
                  "(Debian package graphviz); all else on this page is complete.",
                  reason)};
  return {std::move(notice), Code{graph_text(graph), graph.caption}};
}

}  // namespace

Graph with_closed_subdiagrams(const Graph& graph) {
  Graph closed{graph.caption, {}, {}};
  std::map<std::string, std::size_t, std::less<>> blocks;  // by top-level name
  for (const GraphNode& node : graph.nodes) ++blocks[std::string(top_name(node.path))];
  std::set<std::string, std::less<>> drawn;
  for (const GraphNode& node : graph.nodes) {
    const std::string name(top_name(node.path));
    if (!drawn.insert(name).second) continue;
    if (name == node.path)
      closed.nodes.push_back({node.path, node.type, node.room, {}, {}});
    else
      closed.nodes.push_back({name, fmt::format("{} blocks", blocks[name]), "subdiagram", {}, {}});
  }
  std::set<std::tuple<std::string, std::string>> wires;
  for (const GraphEdge& edge : graph.edges) {
    const std::string from(top_name(edge.from)), to(top_name(edge.to));
    if ((from != to || from == edge.from) && wires.emplace(from, to).second)
      closed.edges.push_back({from, "", to, "", "", ""});
  }
  return closed;
}

std::string graph_text(const Graph& graph) {
  std::string out;
  std::set<std::string, std::less<>> wired;
  for (const GraphEdge& edge : graph.edges) {
    wired.insert({edge.from, edge.to});
    out += fmt::format("{} → {}", end_text(edge.from, edge.from_port), end_text(edge.to, edge.to_port));
    const std::string unit = readable_unit(edge.unit);
    out += unit.empty() ? "\n" : "  " + unit + '\n';
  }
  for (const GraphNode& node : graph.nodes)
    if (!wired.contains(node.path)) out += node.path + '\n';
  return out;
}

std::string graph_source(const Graph& graph) {
  // DejaVu Sans is wide: text measured with it fits its box in any font of the page.
  std::string out = R"(digraph {
rankdir=LR; newrank=true; nodesep=0.3; ranksep=0.42; splines=true; nslimit=4; mclimit=0.4; bgcolor="transparent"; pad=0.1;
fontname="DejaVu Sans"; fontsize=11; style="rounded"; labeljust=l;
node [shape=box, style="rounded,filled", fontname="DejaVu Sans", fontsize=11, margin="0.04,0.03"];
edge [fontname="DejaVu Sans", fontsize=9, arrowsize=0.6];
)";
  int count = 0;
  append_frame(frames_of(graph), out, count);
  const NodesByPath nodes = nodes_by_path(graph);
  for (const GraphEdge& edge : graph.edges) out += edge_source(edge, nodes);
  return out + "}\n";
}

std::vector<Item> graph_picture(const Graph& graph, const GraphOptions& options) {
  const bool closed = graph.nodes.size() > options.most_nodes;
  const Graph drawn = closed ? with_closed_subdiagrams(graph) : graph;
  const ChildResult dot = run_program({options.program, "-Tsvg"}, graph_source(drawn), options.time_limit);
  if (!dot.succeeded) return fallback(graph, dot.failure);
  if (dot.output.find("<svg") == std::string::npos)
    return fallback(graph, fmt::format("{} gave no picture", options.program));
  std::vector<Item> items{Picture{for_page(dot.output), graph.caption, graph_text(drawn)}};
  if (closed)
    items.push_back(Notice{Notice::Severity::note,
                           fmt::format("The diagram has {} blocks, more than the {} that a picture can show: "
                                       "subdiagrams are drawn closed.",
                                       graph.nodes.size(), options.most_nodes)});
  return items;
}

}  // namespace loopwright::report
