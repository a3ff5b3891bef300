#include "engine/plan/layout.h"
#include <fmt/format.h>
#include <algorithm>
#include <numeric>
#include <optional>
#include <span>

namespace loopwright {

Layout::Layout(const FlatDiagram& flat, Plan& plan, Plan::Lists& lists)
    : flat_(flat), plan_(plan), lists_(lists) {
  reserve();
  add_blocks();
  number_constants();
  list_scalars();
  wire_inputs();
  settle_states();
  hand_out_inputs();
}

/// Blocks point into the lists while these grow, so the lists must also have room for the rows that may be
/// added.
void Layout::reserve() {
  size_t blocks = 0, outputs = 0, buffers = 0, inputs = 0, rows = 0;
  for (const FlatBlock& flat : flat_.blocks) {
    const BlockInfo& info = flat.type->info;
    const auto width = size_t(flat.width);
    blocks += width, outputs += width * info.outputs.size(), buffers += width * size_t(info.buffers);
    inputs += width * info.inputs.size();
    for (const PortInfo& input : info.inputs)
      if (input.shape == PortInfo::Shape::vector) rows += width;
  }
  first_instance_.reserve(flat_.blocks.size()), plan_.blocks.reserve(blocks + rows);
  lists_.outputs.reserve(outputs + rows), lists_.output_lengths.reserve(outputs + rows);
  lists_.buffer_lengths.reserve(buffers);
  lists_.input_ports.reserve(inputs + rows), end_of_input_.reserve(inputs + rows);
}

void Layout::add_blocks() {
  for (const FlatBlock& flat : flat_.blocks) {
    first_instance_.push_back(int(plan_.blocks.size()));
    const BlockInfo& info = flat.type->info;
    for (int element = 0; element < flat.width; ++element) {
      Plan::Block& block = plan_.blocks.emplace_back();
      block.path = flat.width == 1 ? flat.path : fmt::format("{}[{}]", flat.path, element);
      block.type = flat.type;
      block.value = flat.elements.empty() ? flat.value : flat.elements[size_t(element)];
      block.place = flat.entry->place;
      block.states = info.state_length(flat.value.get());
      block.first_state = plan_.states;
      plan_.states += block.states;
      add_outputs(flat, element, block);
      block.first_buffer = plan_.buffer_numbers;
      for (int i = 0; i < info.buffers; ++i) {
        lists_.buffer_lengths.push_back(info.buffer_length(flat.value.get(), i));
        plan_.buffer_numbers += lists_.buffer_lengths.back();
      }
      block.buffer_lengths = std::span(lists_.buffer_lengths).last(size_t(info.buffers));
    }
  }
}

/// The first element has the signals of all elements. A state is -1-k until the number of signals is known.
void Layout::add_outputs(const FlatBlock& flat, int element, Plan::Block& block) {
  const auto& ports = flat.type->info.outputs;
  for (size_t o = 0; o < ports.size(); ++o) {
    if (ports[o].state >= 0) {
      lists_.outputs.push_back(-1 - (block.first_state + ports[o].state));
    } else if (element > 0) {
      lists_.outputs.push_back(lists_.outputs[lists_.outputs.size() - ports.size()] + 1);
    } else {
      lists_.outputs.push_back(plan_.signals);
      plan_.signals += ports[o].shape == PortInfo::Shape::vector ? flat.output_lengths[o] : flat.width;
    }
    lists_.output_lengths.push_back(flat.output_lengths[o]);
  }
  block.outputs = std::span(lists_.outputs).last(ports.size());
  block.output_lengths = std::span(lists_.output_lengths).last(ports.size());
}

/// The numbers that an optional input without a wire reads: a vector has its declared length.
static int unwired_length(const FlatBlock& flat, size_t port) {
  const BlockInfo& info = flat.type->info;
  if (info.inputs[port].shape != PortInfo::Shape::vector) return 1;
  return std::max(1, info.input_length(flat.value.get(), int(port)));
}

/// Optional inputs without a wire read constants. Those of equal value are in a row, as many as the longest
/// input needs.
void Layout::number_constants() {
  std::vector<std::pair<double, int>> lengths;  // of each distinct value
  for (const FlatBlock& flat : flat_.blocks)
    for (size_t i = 0; i < flat.inputs.size(); ++i) {
      if (!flat.inputs[i].empty()) continue;
      const double value = flat.type->info.inputs[i].otherwise_value;
      const int length = unwired_length(flat, i);
      const auto found = std::ranges::find(lengths, value, &std::pair<double, int>::first);
      if (found == lengths.end())
        lengths.emplace_back(value, length);
      else
        found->second = std::max(found->second, length);
    }
  for (const auto& [value, length] : lengths)
    for (int i = 0; i < length; ++i) plan_.unwired.emplace_back(plan_.signals++, value);
}

void Layout::list_scalars() {
  first_scalar_.reserve(flat_.blocks.size()), scalars_.reserve(lists_.outputs.size());
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

void Layout::append_numbers(const FlatWire& wire, std::vector<Number>& to) const {
  if (!wire.is_resolved()) return;
  if (const auto scalar = scalar_of(wire)) return to.push_back(*scalar);
  const FlatBlock& flat = flat_.blocks[size_t(wire.block)];
  const size_t first = size_t(first_instance_[size_t(wire.block)]), output = size_t(wire.output);
  const bool is_vector = flat.type->info.outputs[output].shape == PortInfo::Shape::vector;
  const auto number = [&](int i) {
    return is_vector ? plan_.blocks[first].outputs[output] + i
                     : plan_.blocks[first + size_t(i)].outputs[output];
  };
  if (wire.element >= 0) return to.push_back(number(wire.element));
  for (int i = 0; i < (is_vector ? flat.output_lengths[output] : flat.width); ++i) to.push_back(number(i));
}

void Layout::wire_inputs() {
  for (size_t f = 0; f < flat_.blocks.size(); ++f) {
    const auto& ports = flat_.blocks[f].type->info.inputs;
    for (int element = 0; element < flat_.blocks[f].width; ++element)
      for (size_t i = 0; i < ports.size(); ++i) {
        const size_t first = lists_.inputs.size();
        wire_port(flat_.blocks[f], i, element);
        if (ports[i].shape == PortInfo::Shape::vector)
          put_in_a_row(first, plan_.blocks[size_t(first_instance_[f] + element)], ports[i].name);
        end_of_input_.push_back(lists_.inputs.size());
      }
  }
  for (const auto& numbers : scattered_) {
    lists_.inputs.insert(lists_.inputs.end(), numbers.begin(), numbers.end());
    end_of_input_.push_back(lists_.inputs.size());
  }
}

void Layout::wire_port(const FlatBlock& flat, size_t port, int element) {
  const PortInfo& info = flat.type->info.inputs[port];
  if (flat.inputs[port].empty()) {
    const auto first =
        std::ranges::find(plan_.unwired, info.otherwise_value, &std::pair<Number, double>::second);
    for (int i = 0; i < unwired_length(flat, port); ++i) lists_.inputs.push_back(first->first + i);
    return;
  }
  const bool takes_all = info.shape == PortInfo::Shape::vector || info.joins_vectors;
  for (const FlatWire& wire : flat.inputs[port]) {
    const size_t first = lists_.inputs.size();
    append_numbers(wire, lists_.inputs);
    if (takes_all || lists_.inputs.size() == first + 1) continue;
    lists_.inputs[first] = lists_.inputs[first + size_t(element)];
    lists_.inputs.resize(first + 1);
  }
}

/// Replaces scattered numbers by contiguous copies, made by an additional Pack block.
void Layout::put_in_a_row(size_t first, const Plan::Block& reader, std::string_view port) {
  const auto numbers = std::span(lists_.inputs).subspan(first);
  bool in_a_row = !numbers.empty() && numbers[0] >= 0;
  for (size_t i = 1; i < numbers.size(); ++i) in_a_row &= numbers[i] == numbers[i - 1] + 1;
  if (in_a_row) return;
  Plan::Block pack;
  pack.path = fmt::format("{}.{}", reader.path, port);
  pack.type = find_block("Pack");
  const Kernels<double>& kernels = pack.type->kernels;
  void* memory = ::operator new(kernels.size, std::align_val_t(64));
  kernels.construct(memory);
  pack.value = {memory, [&kernels](void* p) {
                  kernels.destroy(p);
                  ::operator delete(p, std::align_val_t(64));
                }};
  lists_.outputs.push_back(plan_.signals), lists_.output_lengths.push_back(int(numbers.size()));
  pack.outputs = std::span(lists_.outputs).last(1);
  pack.output_lengths = std::span(lists_.output_lengths).last(1);
  scattered_.emplace_back(numbers.begin(), numbers.end());
  std::iota(numbers.begin(), numbers.end(), plan_.signals);
  plan_.signals += int(numbers.size());
  plan_.blocks.push_back(std::move(pack));
}

/// States follow the signals: -1-k becomes signals+k, as the number of signals is now known.
void Layout::settle_states() {
  const auto settle = [this](Number& n) {
    if (n < 0) n = plan_.signals + (-1 - n);
  };
  std::ranges::for_each(lists_.inputs, settle);
  std::ranges::for_each(lists_.outputs, settle);
  for (auto& scalar : scalars_)
    if (scalar) settle(*scalar);
}

void Layout::hand_out_inputs() {
  size_t first = 0;
  for (const size_t end : end_of_input_) {
    lists_.input_ports.push_back(std::span(lists_.inputs).subspan(first, end - first));
    first = end;
  }
  size_t port = 0;
  for (Plan::Block& block : plan_.blocks) {
    const size_t ports = block.type->info.inputs.size();
    block.inputs = std::span(lists_.input_ports).subspan(port, ports);
    port += ports;
  }
}

}  // namespace loopwright
