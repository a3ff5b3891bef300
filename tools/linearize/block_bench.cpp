#include "tools/linearize/block_bench.h"
#include <algorithm>
#include <cstring>

namespace loopwright {
namespace {

bool is_computed(const PortInfo& port) { return port.group >= 0; }

/// The numbers on a port of a run.
void append(std::vector<double>& numbers, const Port<double>& port, bool is_many) {
  for (int i = 0; i < port.length; ++i) numbers.push_back(is_many ? *port.many[i] : port.data[i]);
}

}  // namespace

BlockBench::BlockBench(const Run<double>& run, int index)
    : block_(run.plan().blocks[size_t(index)]),
      methods_(block_.type->kernels),
      now_(run.now()),
      original_(run.call(index)),
      call_(original_) {
  connect_inputs(original_);
  connect_outputs(original_);
  states_.resize(size_t(block_.states)), rates_.resize(size_t(block_.states));
  connect_memory(original_);
  call_.state = states_.data(), call_.rate = rates_.data();
  call_.memory = memory_.data(), call_.mode = mode_.data();
  call_.now = &now_, call_.report = &fault_;
  restore();
}

void BlockBench::connect_inputs(const Call<double>& original) {
  const auto& ports = block_.type->info.inputs;
  for (size_t i = 0; i < ports.size(); ++i) {
    Port<double> wire = original.in[i];
    if (block_.inputs[i].empty()) wire.length = 0;
    append(inputs_, wire, ports[i].shape == PortInfo::Shape::many);
  }
  for (const double& number : inputs_) many_.push_back(&number);
  size_t at = 0;
  for (size_t i = 0; i < ports.size(); ++i) {
    Port<double> wire = original.in[i];
    if (ports[i].shape == PortInfo::Shape::many)
      wire.many = many_.data() + at;
    else if (!block_.inputs[i].empty())
      wire.data = inputs_.data() + at;
    at += block_.inputs[i].size();
    in_.push_back(wire);
  }
  call_.in = in_.data();
}

void BlockBench::connect_outputs(const Call<double>& original) {
  const auto& ports = block_.type->info.outputs;
  size_t total = 0;
  for (size_t o = 0; o < ports.size(); ++o)
    if (is_computed(ports[o])) total += size_t(original.out[o].length);
  computed_.resize(total);
  size_t at = 0;
  for (size_t o = 0; o < ports.size(); ++o) {
    Port<double> wire = original.out[o];
    if (is_computed(ports[o])) wire.data = computed_.data() + at, at += size_t(wire.length);
    out_.push_back(wire);
  }
  call_.out = out_.data();
}

void BlockBench::connect_memory(const Call<double>& original) {
  const auto units = [](size_t bytes) { return bytes / sizeof(std::max_align_t) + 1; };
  memory_.resize(units(methods_.memory_size)), mode_.resize(units(methods_.mode_size));
  size_t total = 0;
  for (int length : block_.buffer_lengths) total += size_t(length);
  buffers_.resize(total);
  size_t at = 0;
  for (size_t b = 0; b < block_.buffer_lengths.size(); ++b) {
    Port<double> wire = original.buffers[b];
    wire.data = buffers_.data() + at, at += size_t(wire.length);
    buffer_ports_.push_back(wire);
  }
  call_.buffers = buffer_ports_.data();
  for (int word : block_.type->info.memory_numbers)
    remembered_.push_back(reinterpret_cast<double*>(memory_.data()) + word);
  for (double& number : buffers_) remembered_.push_back(&number);
}

void BlockBench::restore() {
  inputs_.clear();  // keeps its value
  const auto& ports = block_.type->info.inputs;
  for (size_t i = 0; i < ports.size(); ++i) {
    Port<double> wire = original_.in[i];
    if (block_.inputs[i].empty()) wire.length = 0;
    append(inputs_, wire, ports[i].shape == PortInfo::Shape::many);
  }
  std::copy_n(original_.state, states_.size(), states_.begin());
  std::memcpy(memory_.data(), original_.memory, methods_.memory_size);
  std::memcpy(mode_.data(), original_.mode, methods_.mode_size);
  size_t at = 0;
  for (size_t b = 0; b < block_.buffer_lengths.size(); ++b)
    for (int i = 0; i < block_.buffer_lengths[b]; ++i) buffers_[at++] = original_.buffers[b].data[i];
}

std::vector<Number> BlockBench::computed_numbers() const {
  std::vector<Number> numbers;
  for (size_t o = 0; o < out_.size(); ++o)
    if (is_computed(block_.type->info.outputs[o]))
      for (int i = 0; i < out_[o].length; ++i) numbers.push_back(block_.outputs[o] + i);
  return numbers;
}

const double* BlockBench::parameter(std::string_view path) const {
  return methods_.tunable(const_cast<void*>(call_.block), path);  // finds it, changes nothing
}

bool BlockBench::call(Step<double> step) { return !step || step(call_) == 0; }
bool BlockBench::decide() { return call(methods_.decide); }
bool BlockBench::update() { return call(methods_.update); }

bool BlockBench::compute(std::span<double> outputs) {
  for (int group = 0; group < block_.type->info.groups; ++group)
    if (!call(methods_.outputs[group])) return false;
  std::ranges::copy(computed_, outputs.begin());
  return true;
}

bool BlockBench::derivatives(std::span<double> rates) {
  if (!call(methods_.derivatives)) return false;
  std::ranges::copy(rates_, rates.begin());
  return true;
}

bool BlockBench::update_moves_index() {
  restore();
  std::vector<std::max_align_t> before = memory_;
  update();
  const auto* old_words = reinterpret_cast<const uint64_t*>(before.data());
  const auto* new_words = reinterpret_cast<const uint64_t*>(memory_.data());
  bool moves = false;
  for (size_t word = 0; word < methods_.memory_size / sizeof(uint64_t); ++word)
    if (std::ranges::find(block_.type->info.memory_numbers, int(word)) ==
        block_.type->info.memory_numbers.end())
      moves |= old_words[word] != new_words[word];
  restore();
  return moves;
}

}  // namespace loopwright
