#include "engine/plan/shapes.h"
#include <fmt/format.h>
#include <algorithm>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include "engine/plan/groups.h"
#include "engine/json/json.h"

namespace loopwright {

int length_of(const FlatDiagram& flat, const FlatWire& wire) {
  if (!wire.is_resolved() || wire.element >= 0) return 1;
  const FlatBlock& block = flat.blocks[size_t(wire.block)];
  const bool is_vector = block.type->info.outputs[size_t(wire.output)].shape == PortInfo::Shape::vector;
  return is_vector ? block.output_lengths[size_t(wire.output)] : block.width;
}

static bool has_vector_ports(const BlockInfo& info) {
  const auto is_vector = [](const PortInfo& p) {
    return p.shape == PortInfo::Shape::vector || p.joins_vectors;
  };
  return std::ranges::any_of(info.inputs, is_vector) || std::ranges::any_of(info.outputs, is_vector);
}

constexpr int longest_vector = 1'000'000;      // elements
constexpr int64_t most_numbers = 500'000'000;  // in the arena of a run: 4 GB

static int total_length(const FlatDiagram& flat, std::span<const FlatWire> wires) {
  int64_t n = 0;
  for (const FlatWire& wire : wires) n += length_of(flat, wire);
  return int(std::min<int64_t>(n, longest_vector + 1));
}

/// Updates the width and output lengths of the block from its present inputs; true if anything grew.
static bool update_shape(FlatDiagram& flat, FlatBlock& block) {
  const BlockInfo& info = block.type->info;
  const int old_width = block.width;
  block.width = std::max(block.width, int(block.elements.size()));
  if (!has_vector_ports(info))
    for (const auto& wires : block.inputs)
      for (const FlatWire& wire : wires) block.width = std::max(block.width, length_of(flat, wire));
  bool grew = block.width != old_width;
  for (size_t o = 0; o < info.outputs.size(); ++o) {
    int n = 1;
    if (info.outputs[o].shape == PortInfo::Shape::vector) {
      const int own = info.output_length(block.value.get(), int(o)), like = info.outputs[o].length_of_input;
      n = own >= 0 ? own : like >= 0 ? total_length(flat, block.inputs[size_t(like)]) : 1;
    }
    grew |= n != block.output_lengths[o];
    block.output_lengths[o] = n;
  }
  return grew;
}

/// The setting that determines the number of wires: "signs" of a Sum, "names" of an Expression.
static std::string who_asks_for(int wires, const Value& settings) {
  for (const Value::Member& member : settings.members) {
    const bool is_text = member.value.kind == Value::Kind::text;
    const bool is_list = member.value.kind == Value::Kind::list;
    const size_t length = is_text ? member.value.text.size() : member.value.items.size();
    if ((is_text || is_list) && length == size_t(wires))
      return fmt::format("\"{}\": {} asks for {} wires", member.name, to_json(member.value), wires);
  }
  return "";
}

static void check_port(const FlatDiagram& flat, const FlatBlock& block, size_t i, Problems& problems) {
  const PortInfo& port = block.type->info.inputs[i];
  const auto& wires = block.inputs[i];
  const int wanted = block.type->info.input_length(block.value.get(), int(i));
  if (wires.empty()) {
    const auto listed = std::ranges::find(block.entry->in, port.name, &PortWires::port);  // an empty list
    if (port.shape == PortInfo::Shape::many && listed != block.entry->in.end() && wanted != 0 &&
        !port.is_optional)
      problems
          .error(listed->place, listed->place.pointer(), block.path,
                 fmt::format("the input \"{}\" is not wired", port.name))
          .expected = wanted > 0 ? fmt::format("{} wires", wanted) : "at least one wire";
    return;
  }
  const auto clash = [&](const FlatWire& wire, std::string expected, std::string found) -> Problem& {
    const Place& place = wire.at && wire.at->place.file ? wire.at->place : block.entry->place;
    auto& p = problems.error(place, place.pointer(), block.path,
                             fmt::format("the input \"{}\" has the wrong width", port.name));
    p.expected = std::move(expected), p.found = std::move(found);
    return p;
  };
  if (port.shape == PortInfo::Shape::many && !port.joins_vectors) {
    if (wanted >= 0 && int(wires.size()) != wanted) {
      clash(wires[0], fmt::format("{} wires", wanted), fmt::format("{}", wires.size())).hint =
          who_asks_for(wanted, block.entry->settings);
    }
  } else if (port.shape != PortInfo::Shape::scalar) {
    const int n = total_length(flat, wires);
    if (wanted >= 0 && n != wanted) clash(wires[0], fmt::format("{} elements", wanted), fmt::format("{}", n));
    return;
  }
  const int width = has_vector_ports(block.type->info) ? 1 : block.width;
  for (const FlatWire& wire : wires) {
    const int n = length_of(flat, wire);
    if (n != 1 && n != width)
      clash(wire,
            width == 1 ? "a scalar; an element is written \"block.port[0]\""
                       : fmt::format("a scalar or {} elements, as its other inputs have", width),
            fmt::format("\"{}\" with {} elements", wire.at->source, n));
  }
}

/// Numbers that differ by element are as many as the elements of the wires.
static void check_elements(const FlatBlock& block, Problems& problems) {
  const size_t elements = block.elements.size();
  if (elements < 2 || elements == size_t(block.width)) return;
  for (const Value::Member& member : block.entry->settings.members)
    if (member.value.kind == Value::Kind::list && member.value.items.size() == elements) {
      auto& p = problems.error(
          member.value.place, member.value.place.pointer(), block.path,
          fmt::format("\"{}\" has {} elements, and the wires have {}", member.name, elements, block.width));
      p.expected = fmt::format("a number, or a list of {}", block.width);
      return;
    }
}

/// The element named by a wire must exist. A wire with many readers is reported once.
static void check_element(const FlatDiagram& flat, const FlatWire& wire, const std::string& reader,
                          std::set<std::string>& told, Problems& problems) {
  if (!wire.is_resolved() || wire.element < 0) return;
  FlatWire whole = wire;
  whole.element = -1;
  const int n = length_of(flat, whole);
  if (wire.element < n || !told.insert(fmt::format("{}@{}", wire.at->source, wire.at->place.offset)).second)
    return;
  problems
      .error(wire.at->place, wire.at->place.pointer(), reader,
             fmt::format("\"{}\" has {} elements, counted from 0",
                         wire.at->source.substr(0, wire.at->source.find('[')), n))
      .found = "\"" + wire.at->source + "\"";
}

/// All numbers of a run must fit into memory, and their indices into a Number. Too many are reported at the
/// block that needs the most.
static void check_size(const FlatDiagram& flat, Problems& problems) {
  int64_t total = 0, greatest = -1;
  const FlatBlock* greediest = nullptr;
  for (const FlatBlock& block : flat.blocks) {
    const BlockInfo& info = block.type->info;
    int64_t numbers =
        5 * int64_t(info.state_length(block.value.get()));  // including a solver's copies of each state
    for (int length : block.output_lengths) numbers += length;
    for (int i = 0; i < info.buffers; ++i) numbers += info.buffer_length(block.value.get(), i);
    numbers *= block.width;
    total += numbers;
    if (numbers > greatest) greatest = numbers, greediest = &block;
  }
  if (total <= most_numbers) return;
  auto& p = problems.error(
      greediest->entry->place, greediest->entry->place.pointer(), greediest->path,
      fmt::format("the diagram needs {:.3g} GB of memory, most of it here", 8e-9 * double(total)));
  p.expected = fmt::format("at most {:.3g} GB", 8e-9 * double(most_numbers));
}

static Groups readers_of_blocks(const FlatDiagram& flat) {
  return Groups(flat.blocks.size(), [&](const auto& tell) {
    for (size_t b = 0; b < flat.blocks.size(); ++b)
      for (const auto& wires : flat.blocks[b].inputs)
        for (const FlatWire& wire : wires)
          if (wire.is_resolved()) tell(size_t(wire.block), int(b));
  });
}

void find_shapes(FlatDiagram& flat, Problems& problems) {
  std::optional<Groups> readers;  // built only if a vector is found
  std::vector<int> todo(flat.blocks.size());
  std::iota(todo.rbegin(), todo.rend(), 0);
  std::vector<int> visits(flat.blocks.size(), 0);
  while (!todo.empty()) {
    const int b = todo.back();
    todo.pop_back();
    FlatBlock& block = flat.blocks[size_t(b)];
    if (!update_shape(flat, block)) continue;
    if (block.width > longest_vector ||
        std::ranges::any_of(block.output_lengths, [](int n) { return n > longest_vector; })) {
      auto& p = problems.error(block.entry->place, block.entry->place.pointer(), block.path,
                               "its vectors are too long");
      p.expected = fmt::format("at most {} elements", longest_vector),
      p.hint = "does a vector that grows feed itself?";
      return;
    }
    if (++visits[size_t(b)] > 50) {
      problems.error(block.entry->place, block.entry->place.pointer(), block.path,
                     "its vectors grow without end around a cycle of wires");
      return;
    }
    if (!readers) readers = readers_of_blocks(flat);
    const auto those = (*readers)[size_t(b)];
    todo.insert(todo.end(), those.begin(), those.end());
  }
  std::set<std::string> told;
  for (const FlatBlock& block : flat.blocks) {
    check_elements(block, problems);
    for (size_t i = 0; i < block.inputs.size(); ++i) check_port(flat, block, i, problems);
    for (const auto& wires : block.inputs)
      for (const FlatWire& wire : wires) check_element(flat, wire, block.path, told, problems);
  }
  for (const FlatLog& log : flat.log) check_element(flat, log.wire, "log", told, problems);
  for (const FlatName& name : flat.names) check_element(flat, name.wire, name.name, told, problems);
  check_size(flat, problems);
}

}  // namespace loopwright
