#include "tools/draw/diagram_graph.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <set>
#include "engine/plan/gates.h"
#include "engine/plan/unit_expressions.h"
#include "tools/draw/block_face.h"
#include "tools/draw/machine_chart.h"
#include "tools/draw/signal_rates.h"
#include "tools/report/typography.h"

namespace loopwright {
namespace {

using report::GraphEnd;
using Side = GraphEnd::Side;

/// The nodes of one diagram file in use.
struct Level {
  const Diagram* diagram = nullptr;
  size_t container = 0;  ///< the node around it; not of the outermost diagram
  bool is_outermost = false;
  std::map<std::string_view, size_t> nodes;                  ///< by name of the block
  std::map<std::string_view, std::unique_ptr<Level>> inner;  ///< of subdiagrams
};

/// "$y/$u" with N and V is "N/V", as one would write it; empty where names would need brackets or cancel.
std::string substituted(std::string_view text, const UnitExpression& expression,
                        const std::vector<std::optional<Unit>>& variables) {
  if (size_t(std::ranges::count(text, '$')) != expression.factors.size()) return {};
  std::string out;
  std::set<std::string> used;
  for (const UnitFactor& factor : expression.factors) {  // in the order of the text
    const size_t dollar = text.find('$');
    const auto& variable = variables[size_t(factor.variable)];
    const std::string name = variable ? to_string(*variable) : "";
    if (name.empty() || name == "1" || name.find_first_of("*/^ ") != name.npos || !used.insert(name).second)
      return {};
    out += std::string(text.substr(0, dollar)) + name;
    text.remove_prefix(std::min(text.find_first_of("*/^", dollar), text.size()));
  }
  return out + std::string(text);
}

class GraphBuilder {
 public:
  explicit GraphBuilder(const Plan& plan)
      : plan_(plan), rates_(plan), settings_(plan.parameters.begin(), plan.parameters.end()) {
    for (const Plan::Block& block : plan.blocks) types_.emplace(block.path, block.type);
  }

  report::Graph build(const Diagram& diagram) {
    Level top;
    top.is_outermost = true;
    add_nodes(diagram, "", top);
    add_wires(top, "");
    graph_.caption = diagram.title;
    graph_.rates = rates_.names();
    return std::move(graph_);
  }

 private:
  static std::string joined(const std::string& prefix, std::string_view name) {
    return prefix.empty() ? std::string(name) : fmt::format("{}.{}", prefix, name);
  }

  std::string unit_of(const std::string& port) const {
    const std::vector<Number> numbers = plan_.find(port);
    if (numbers.empty()) return {};
    const auto unit = plan_.unit_of(numbers.front());
    return unit ? to_string(*unit) : std::string();
  }

  report::GraphPort port(const std::string& path, std::string_view name) {
    const std::string full = joined(path, name);
    const std::vector<Number> numbers = plan_.find(full);
    return {std::string(name), unit_of(full), "", numbers.empty() ? -1 : rates_.index_of(numbers.front())};
  }

  void add_nodes(const Diagram& diagram, const std::string& prefix, Level& level) {
    level.diagram = &diagram;
    for (const BlockEntry& block : diagram.blocks) {
      const std::string path = joined(prefix, block.name);
      const size_t index = graph_.nodes.size();
      level.nodes.emplace(block.name, index);
      if (block.subdiagram) {
        graph_.nodes.push_back(subdiagram_node(block, path));
        auto& inner = level.inner[block.name] = std::make_unique<Level>();
        inner->container = index;
        add_nodes(*block.subdiagram, path, *inner);
      } else if (const BlockType* type = type_of(block, path)) {
        graph_.nodes.push_back(block_node(block, *type, path));
      }
    }
  }

  /// With the ports that the instance declares.
  const BlockType* type_of(const BlockEntry& block, const std::string& path) const {
    const auto found = types_.find(path);  // of several scalar instances of a block, "gain[2]", there is none
    return found == types_.end() ? find_block(block.type) : found->second;
  }

  report::GraphNode subdiagram_node(const BlockEntry& block, const std::string& path) {
    const Diagram& inside = *block.subdiagram;
    report::GraphNode node{
        path, std::filesystem::path(inside.path).filename().string(), "subdiagram", {}, {}, {}, inside.title};
    for (const DiagramInput& input : inside.inputs) node.inputs.push_back(port(path, input.name));
    for (const DiagramOutput& output : inside.outputs) node.outputs.push_back(port(path, output.name));
    if (block.condition) {
      node.inputs.push_back({block.condition->key, "", "", -1});
      node.outputs.push_back(port(path, gate_name));
    }
    return node;
  }

  report::GraphNode block_node(const BlockEntry& block, const BlockType& type, const std::string& path) {
    report::GraphNode node{path, type.info.type, type.info.room, {}, {}, {}, {}};
    const ShownSettings settings(type, path, settings_, parameter_units(type, path));
    for (const PortInfo& input : type.info.inputs) {
      const auto wires = std::ranges::find(block.in, input.name, &PortWires::port);
      if (wires == block.in.end()) continue;  // optional, and not wired
      if (!wires->is_list) {
        node.inputs.push_back({std::string(input.name), "", "", -1});
        continue;
      }
      const std::vector<std::string> signs = wire_signs(settings, wires->wires.size());
      for (size_t i = 0; i < wires->wires.size(); ++i)
        node.inputs.push_back({fmt::format("{}[{}]", input.name, i), "", signs[i], -1});
    }
    for (const PortInfo& output : type.info.outputs) node.outputs.push_back(port(path, output.name));
    node.face = block_face(settings, node.inputs.size());
    node.details = settings.all();
    if (type.info.type == "StateMachine") {
      node.chart = machine_chart(settings);
      node.face.text = fmt::format("{} states", node.chart.states.size());
    }
    return node;
  }

  /// A unit in the description of a parameter follows from the units of the wires at the block.
  std::function<std::string(std::string_view)> parameter_units(const BlockType& type,
                                                               const std::string& path) const {
    const auto known = std::make_shared<TypeUnits>(type.info);
    std::vector<std::optional<Unit>> variables(known->variables());
    const auto learn = [&](const UnitExpression& expression, std::string_view port) {
      if (expression.factors.size() != 1 || expression.factors[0].exponent != 1) return;
      const std::vector<Number> numbers = plan_.find(joined(path, port));
      const auto unit = numbers.empty() ? std::nullopt : plan_.unit_of(numbers.front());
      if (unit) variables[size_t(expression.factors[0].variable)] = *unit * power(expression.constant, -1);
    };
    for (size_t i = 0; i < type.info.inputs.size(); ++i) learn(known->of_input(i), type.info.inputs[i].name);
    for (size_t o = 0; o < type.info.outputs.size(); ++o)
      learn(known->of_output(o), type.info.outputs[o].name);
    return [known, variables](std::string_view text) -> std::string {
      if (text.find('$') == text.npos) return std::string(text);
      const UnitExpression& expression = known->of(text);
      if (std::string plain = substituted(text, expression, variables); !plain.empty()) return plain;
      Unit unit = expression.constant;
      for (const UnitFactor& factor : expression.factors) {
        const auto& variable = variables[size_t(factor.variable)];
        if (!variable) return {};
        unit = unit * power(*variable, factor.exponent);
      }
      return to_string(unit);
    };
  }

  // ---- Wires ----

  void add_wires(Level& level, const std::string& prefix) {
    for (const BlockEntry& block : level.diagram->blocks) {
      const auto node = level.nodes.find(block.name);
      if (node == level.nodes.end()) continue;
      for (const PortWires& wires : block.in)
        for (size_t i = 0; i < wires.wires.size(); ++i)
          connect(level, prefix, wires.wires[i].source,
                  input_end(node->second, wires.is_list ? fmt::format("{}[{}]", wires.port, i) : wires.port));
      if (block.condition)
        connect(level, prefix, block.condition->wire.source, input_end(node->second, block.condition->key));
      if (block.subdiagram) {
        Level& inner = *level.inner[block.name];
        const std::string path = joined(prefix, block.name);
        add_wires(inner, path);
        for (size_t o = 0; o < block.subdiagram->outputs.size(); ++o)
          connect(inner, path, block.subdiagram->outputs[o].source.source,
                  GraphEnd{inner.container, Side::output, o});
      }
    }
  }

  std::optional<GraphEnd> input_end(size_t node, std::string_view port) const {
    const auto& inputs = graph_.nodes[node].inputs;
    const auto found = std::ranges::find(inputs, port, &report::GraphPort::name);
    if (found == inputs.end()) return std::nullopt;
    return GraphEnd{node, Side::input, size_t(found - inputs.begin())};
  }

  void connect(Level& level, const std::string& prefix, std::string_view source, std::optional<GraphEnd> to) {
    const auto from = source_end(level, prefix, source.substr(0, source.find('[')));
    if (from && to) graph_.edges.push_back({*from, *to});
  }

  /// The end at this level that carries a source: an input of the diagram, an output of a block, or an output
  /// of a subdiagram. A path that reaches into a subdiagram, "stage.mass.velocity", becomes an output of it.
  std::optional<GraphEnd> source_end(Level& level, const std::string& prefix, std::string_view source) {
    const size_t dot = source.find('.');
    if (dot == source.npos) {
      if (level.is_outermost) return std::nullopt;
      const auto& inputs = level.diagram->inputs;
      const auto found = std::ranges::find(inputs, source, &DiagramInput::name);
      if (found == inputs.end()) return std::nullopt;
      return GraphEnd{level.container, Side::input, size_t(found - inputs.begin())};
    }
    const std::string_view name = source.substr(0, dot), rest = source.substr(dot + 1);
    const auto node = level.nodes.find(name);
    if (node == level.nodes.end()) return std::nullopt;
    auto& outputs = graph_.nodes[node->second].outputs;
    const auto found = std::ranges::find(outputs, rest, &report::GraphPort::name);
    if (found != outputs.end()) return GraphEnd{node->second, Side::output, size_t(found - outputs.begin())};
    const auto inner = level.inner.find(name);
    if (inner == level.inner.end()) return std::nullopt;
    const std::string path = joined(prefix, name);
    const auto inside = source_end(*inner->second, path, rest);
    if (!inside) return std::nullopt;
    const GraphEnd end{node->second, Side::output, graph_.nodes[node->second].outputs.size()};
    graph_.nodes[node->second].outputs.push_back(port(path, rest));
    graph_.edges.push_back({*inside, end});
    return end;
  }

  const Plan& plan_;
  SignalRates rates_;
  EffectiveSettings settings_;
  std::map<std::string_view, const BlockType*> types_;  ///< of the blocks of the plan, by path
  report::Graph graph_;
};

size_t block_count(const Diagram& diagram, size_t depth) {
  size_t count = diagram.blocks.size();
  if (depth > 0)
    for (const BlockEntry& block : diagram.blocks)
      if (block.subdiagram) count += block_count(*block.subdiagram, depth - 1);
  return count;
}

}  // namespace

report::Graph diagram_graph(const Diagram& diagram, const Plan& plan, size_t most_nodes) {
  constexpr size_t deepest = 32;  // nesting of subdiagrams
  report::Graph graph = GraphBuilder(plan).build(diagram);
  if (graph.nodes.size() <= most_nodes) return graph;
  size_t depth = 0;
  while (depth < deepest && block_count(diagram, depth + 1) <= most_nodes) ++depth;
  return report::down_to(graph, depth);
}

}  // namespace loopwright
