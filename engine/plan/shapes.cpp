#include "engine/plan/shapes.h"
#include <fmt/format.h>
#include <algorithm>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include "engine/plan/groups.h"

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

/// The block's width and output lengths from its inputs as they are now; true if anything grew.
static bool update_shape(FlatDiagram& flat, FlatBlock& block) {
  const BlockInfo& info = block.type->info;
  const int old_width = block.width;
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
  const auto clash = [&](const FlatWire& wire, std::string expected, std::string found) {
    const Place& place = wire.at && wire.at->place.file ? wire.at->place : block.entry->place;
    auto& p = problems.error(place, place.pointer(), block.path,
                             fmt::format("the input \"{}\" has the wrong width", port.name));
    p.expected = std::move(expected), p.found = std::move(found);
  };
  if (port.shape == PortInfo::Shape::many && !port.joins_vectors) {
    if (wanted >= 0 && int(wires.size()) != wanted)
      clash(wires[0], fmt::format("{} wires", wanted), fmt::format("{}", wires.size()));
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

/// An element that a wire names must be there. A wire has many readers; it is told once.
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

/// All numbers of a run must fit into memory, and their places into a Number; told at the block that takes
/// the most.
static void check_size(const FlatDiagram& flat, Problems& problems) {
  int64_t total = 0, greatest = -1;
  const FlatBlock* greediest = nullptr;
  for (const FlatBlock& block : flat.blocks) {
    const BlockInfo& info = block.type->info;
    int64_t numbers =
        5 * int64_t(info.state_length(block.value.get()));  // with what a solver keeps of each state
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
  std::optional<Groups> readers;  // listed once a vector is found
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
                     "its vectors grow round a ring of wires without end");
      return;
    }
    if (!readers) readers = readers_of_blocks(flat);
    const auto those = (*readers)[size_t(b)];
    todo.insert(todo.end(), those.begin(), those.end());
  }
  std::set<std::string> told;
  for (const FlatBlock& block : flat.blocks) {
    for (size_t i = 0; i < block.inputs.size(); ++i) check_port(flat, block, i, problems);
    for (const auto& wires : block.inputs)
      for (const FlatWire& wire : wires) check_element(flat, wire, block.path, told, problems);
  }
  for (const FlatLog& log : flat.log) check_element(flat, log.wire, "log", told, problems);
  for (const FlatName& name : flat.names) check_element(flat, name.wire, name.name, told, problems);
  check_size(flat, problems);
}

Layout::Layout(const FlatDiagram& flat, Plan& plan) : flat_(flat), plan_(plan) {
  add_blocks();
  number_constants_and_states();
  list_scalars();
  wire_inputs();
}

void Layout::add_blocks() {
  size_t blocks = 0;
  for (const FlatBlock& flat : flat_.blocks) blocks += size_t(flat.width);
  first_instance_.reserve(flat_.blocks.size()), plan_.blocks.reserve(blocks);
  for (const FlatBlock& flat : flat_.blocks) {
    first_instance_.push_back(int(plan_.blocks.size()));
    const BlockInfo& info = flat.type->info;
    std::vector<Number> first_output(info.outputs.size(), -1);
    for (size_t o = 0; o < info.outputs.size(); ++o) {
      if (info.outputs[o].state >= 0) continue;
      first_output[o] = plan_.signals;
      plan_.signals += info.outputs[o].shape == PortInfo::Shape::vector ? flat.output_lengths[o] : flat.width;
    }
    for (int element = 0; element < flat.width; ++element) {
      Plan::Block block;
      block.path = flat.width == 1 ? flat.path : fmt::format("{}[{}]", flat.path, element);
      block.type = flat.type, block.value = flat.value, block.place = flat.entry->place;
      block.output_lengths.assign(flat.output_lengths.begin(), flat.output_lengths.end());
      block.outputs.reserve(first_output.size());
      for (Number n : first_output) block.outputs.push_back(n < 0 ? n : n + element);
      block.states = info.state_length(flat.value.get());
      block.first_state = plan_.states;
      plan_.states += block.states;
      block.first_buffer = plan_.buffer_numbers;
      block.buffer_lengths.reserve(size_t(info.buffers));
      for (int i = 0; i < info.buffers; ++i) {
        block.buffer_lengths.push_back(info.buffer_length(flat.value.get(), i));
        plan_.buffer_numbers += block.buffer_lengths.back();
      }
      plan_.blocks.push_back(std::move(block));
    }
  }
}

void Layout::number_constants_and_states() {
  // Optional inputs without a wire read constants, one signal a distinct value.
  for (const FlatBlock& flat : flat_.blocks)
    for (size_t i = 0; i < flat.inputs.size(); ++i) {
      if (!flat.inputs[i].empty()) continue;
      const double value = flat.type->info.inputs[i].otherwise_value;
      if (std::ranges::none_of(plan_.unwired, [&](const auto& u) { return u.second == value; }))
        plan_.unwired.emplace_back(plan_.signals++, value);
    }
  for (Plan::Block& block : plan_.blocks)
    for (size_t o = 0; o < block.outputs.size(); ++o)
      if (const int state = block.type->info.outputs[o].state; state >= 0)
        block.outputs[o] = -1 - (block.first_state + state);
}

void Layout::list_scalars() {
  for (size_t f = 0; f < flat_.blocks.size(); ++f) {
    const FlatBlock& flat = flat_.blocks[f];
    const auto& outputs = plan_.blocks[size_t(first_instance_[f])].outputs;
    first_scalar_.push_back(scalars_.size());
    for (size_t o = 0; o < outputs.size(); ++o) {
      const bool is_scalar = flat.width == 1 && flat.type->info.outputs[o].shape != PortInfo::Shape::vector;
      scalars_.push_back(is_scalar ? std::optional(outputs[o]) : std::nullopt);
    }
  }
}

std::optional<Number> Layout::scalar_of(const FlatWire& wire) const {
  if (!wire.is_resolved() || wire.element > 0) return {};
  return scalars_[first_scalar_[size_t(wire.block)] + size_t(wire.output)];
}

std::vector<Number> Layout::numbers_of(const FlatWire& wire) const {
  if (const auto scalar = scalar_of(wire)) return {*scalar};
  std::vector<Number> numbers;
  if (!wire.is_resolved()) return numbers;
  const FlatBlock& flat = flat_.blocks[size_t(wire.block)];
  const size_t first = size_t(first_instance_[size_t(wire.block)]), output = size_t(wire.output);
  if (flat.type->info.outputs[output].shape == PortInfo::Shape::vector)
    for (int i = 0; i < flat.output_lengths[output]; ++i)
      numbers.push_back(plan_.blocks[first].outputs[output] + i);
  else
    for (int i = 0; i < flat.width; ++i) numbers.push_back(plan_.blocks[first + size_t(i)].outputs[output]);
  if (wire.element >= 0) numbers = {numbers[size_t(wire.element)]};
  return numbers;
}

/// A copy of scattered numbers in a row, made by a Pack that nobody wrote.
std::vector<Number> Layout::contiguous(std::vector<Number> numbers, const std::string& reader) {
  bool in_a_row = true;
  for (size_t i = 1; i < numbers.size(); ++i)
    in_a_row &= numbers[i] == numbers[i - 1] + 1 && numbers[i - 1] >= 0;
  if (in_a_row && !numbers.empty() && numbers[0] >= 0) return numbers;
  Plan::Block pack;
  pack.path = reader;
  pack.type = find_block("Pack");
  const Kernels<double>& kernels = pack.type->kernels;
  void* memory = ::operator new(kernels.size, std::align_val_t(64));
  kernels.construct(memory);
  pack.value = {memory, [&kernels](void* p) {
                  kernels.destroy(p);
                  ::operator delete(p, std::align_val_t(64));
                }};
  const int n = int(numbers.size());
  pack.inputs = {std::move(numbers)};
  pack.outputs = {plan_.signals};
  pack.output_lengths = {n};
  plan_.signals += n;
  std::vector<Number> copies(static_cast<size_t>(n));
  std::iota(copies.begin(), copies.end(), pack.outputs[0]);
  plan_.blocks.push_back(std::move(pack));
  return copies;
}

void Layout::wire_port(Plan::Block& block, const FlatBlock& flat, size_t port, int element) {
  const PortInfo& info = flat.type->info.inputs[port];
  std::vector<Number>& numbers = block.inputs[port];
  if (flat.inputs[port].empty()) {
    for (const auto& [number, value] : plan_.unwired)
      if (value == info.otherwise_value) numbers = {number};
    return;
  }
  const auto& wires = flat.inputs[port];
  numbers.reserve(wires.size());
  for (const FlatWire& wire : wires) {
    if (const auto scalar = scalar_of(wire)) {
      numbers.push_back(*scalar);
      continue;
    }
    const std::vector<Number> all = numbers_of(wire);
    if (info.shape == PortInfo::Shape::vector || info.joins_vectors)
      numbers.insert(numbers.end(), all.begin(), all.end());
    else
      numbers.push_back(all[all.size() == 1 ? 0 : size_t(element)]);
  }
}

void Layout::wire_inputs() {
  const size_t written = plan_.blocks.size();
  for (size_t b = 0, f = 0; f < flat_.blocks.size(); ++f)
    for (int element = 0; element < flat_.blocks[f].width; ++element, ++b) {
      plan_.blocks[b].inputs.resize(flat_.blocks[f].inputs.size());
      for (size_t i = 0; i < flat_.blocks[f].inputs.size(); ++i)
        wire_port(plan_.blocks[b], flat_.blocks[f], i, element);
    }
  for (size_t b = 0; b < written; ++b)
    for (size_t i = 0; i < plan_.blocks[b].inputs.size(); ++i) {
      const PortInfo& port = plan_.blocks[b].type->info.inputs[i];
      if (port.shape != PortInfo::Shape::vector) continue;
      auto numbers =
          contiguous(plan_.blocks[b].inputs[i], plan_.blocks[b].path + "." + std::string(port.name));
      plan_.blocks[b].inputs[i] = std::move(numbers);
    }
  // States come after the signals: -1-k becomes signals+k, now that the number of signals is known.
  const auto settle = [this](Number& n) {
    if (n < 0) n = plan_.signals + (-1 - n);
  };
  for (Plan::Block& block : plan_.blocks) {
    for (auto& port : block.inputs) std::ranges::for_each(port, settle);
    std::ranges::for_each(block.outputs, settle);
  }
  for (auto& scalar : scalars_)
    if (scalar) settle(*scalar);
}

}  // namespace loopwright
