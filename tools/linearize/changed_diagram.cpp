#include "tools/linearize/changed_diagram.h"
#include <fmt/format.h>
#include <algorithm>
#include "engine/json/reader.h"

namespace loopwright {
namespace {

/// "sum.terms" for "sum.in.terms", the name of an input beside an output of the same name.
std::string without_in(std::string port) {
  const size_t in = port.find(".in."), dot = port.find('.');
  if (in != port.npos && in == dot) port.erase(in, 3);
  return port;
}

/// The wire of a port such as "sum.terms[1]"; null after a problem.
Wire* find_wire(Diagram& diagram, const std::string& port, const char* obstacle, Problems& problems) {
  const std::string wanted = without_in(port);
  KnownNames known;
  for (BlockEntry& block : diagram.blocks)
    for (PortWires& wires : block.in) {
      const std::string name = block.name + "." + wires.port;
      for (size_t i = 0; i < wires.wires.size(); ++i)
        if ((wires.wires.size() == 1 && name == wanted) || fmt::format("{}[{}]", name, i) == wanted)
          return &wires.wires[i];
      known.add(name);
    }
  Problem& problem = problems.error({}, "", "", fmt::format(fmt::runtime(obstacle), port));
  problem.expected = "an input port of an outermost block that is wired, with [i] where it has several wires";
  known.explain(problem, wanted.substr(0, wanted.find('[')));
  return nullptr;
}

/// Inserts blocks before one port.
class Insertion {
 public:
  Insertion(Diagram& diagram, const Place& place) : diagram_(diagram), place_(place) {}

  /// The name of the added block.
  std::string add(BlockEntry block) {
    while (std::ranges::find(diagram_.blocks, block.name, &BlockEntry::name) != diagram_.blocks.end())
      block.name += '_';
    block.place = block.type_place = place_;
    diagram_.blocks.push_back(block);
    return block.name;
  }
  /// The output of a switch from one output to another at a time.
  std::string switched(const std::string& before, const std::string& after, double time) {
    const std::string clock = add(block_with("switch_time", "Step", {{"time", time}}));
    BlockEntry chosen = block_with("switched", "Switch", {});
    chosen.in = {port("control", clock + ".y"), port("first", after), port("second", before)};
    return add(chosen) + ".y";
  }
  std::string sum(const std::string& first, const std::string& second) {
    BlockEntry block = block_with("added_sum", "Sum", {});
    block.in = {{"terms", place_, true, {{first, place_}, {second, place_}}}};
    return add(block) + ".sum";
  }

 private:
  PortWires port(const char* name, const std::string& source) const {
    return {name, place_, false, {{source, place_}}};
  }
  Diagram& diagram_;
  const Place place_;
};

}  // namespace

BlockEntry block_with(std::string name, std::string type,
                      std::initializer_list<std::pair<const char*, double>> settings) {
  BlockEntry block;
  block.name = std::move(name), block.type = std::move(type);
  block.settings.kind = Value::Kind::object;
  for (const auto& [key, number] : settings) {
    Value value;
    value.kind = Value::Kind::number;
    value.number = number;
    block.settings.members.push_back({key, {}, std::move(value)});
  }
  return block;
}

const PortWires* wires_into(const Diagram& diagram, const std::string& port) {
  const std::string wanted = without_in(port);
  for (const BlockEntry& block : diagram.blocks)
    for (const PortWires& wires : block.in)
      if (block.name + "." + wires.port == wanted) return &wires;
  return nullptr;
}

Diagram with_added_signal(const Diagram& diagram, const std::string& port, const BlockEntry& source,
                          Problems& problems, std::optional<double> time) {
  Diagram result = diagram;
  const Wire* const found = find_wire(result, port, "no signal can be added to \"{}\"", problems);
  if (!found) return result;
  const Wire wire = *found;
  Insertion insertion(result, wire.place);
  std::string added = insertion.add(source) + ".y";
  if (time) {
    const std::string nothing = insertion.add(block_with("no_signal", "Constant", {{"value", 0}}));
    added = insertion.switched(nothing + ".y", added, *time);
  }
  const std::string sum = insertion.sum(wire.source, added);
  find_wire(result, port, "", problems)->source = sum;  // added blocks may have moved the wires
  return result;
}

Diagram with_cut_port(const Diagram& diagram, const std::string& port, double value,
                      std::optional<double> time, Problems& problems) {
  Diagram result = diagram;
  const Wire* const found = find_wire(result, port, "no cut can be simulated at \"{}\"", problems);
  if (!found) return result;
  const Wire wire = *found;
  Insertion insertion(result, wire.place);
  std::string held = insertion.add(block_with("held", "Constant", {{"value", value}})) + ".y";
  if (time) held = insertion.switched(wire.source, held, *time);
  find_wire(result, port, "", problems)->source = held;
  return result;
}

}  // namespace loopwright
