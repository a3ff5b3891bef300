#include "tests/blocks/block_under_test.h"
#include <algorithm>
#include <cstring>
#include <stdexcept>
#include "engine/json/json.h"

namespace loopwright {

static const BlockType& registered(std::string_view type) {
  if (const BlockType* found = find_block(type)) return *found;
  throw std::invalid_argument("no block is called " + std::string(type));
}
static size_t index_of(const auto& entries, std::string_view name, const char* what) {
  for (size_t i = 0; i < entries.size(); ++i)
    if (entries[i].name == name) return i;
  throw std::invalid_argument("there is no " + std::string(what) + " " + std::string(name));
}

BlockUnderTest::BlockUnderTest(std::string_view type, std::string_view settings, double sample_time)
    : BlockUnderTest(type, settings, Setup{sample_time}) {}
BlockUnderTest::BlockUnderTest(std::string_view type, std::string_view settings, const Setup& setup)
    : type_(registered(type)), setup_(setup) {
  build(settings);
}
BlockUnderTest::~BlockUnderTest() { type_.kernels.destroy(block_); }

void BlockUnderTest::build(std::string_view settings) {
  const auto& kernels = type_.kernels;
  size_t space = kernels.size + kernels.align;
  storage_ = std::make_unique<std::byte[]>(space);
  block_ = storage_.get();
  std::align(kernels.align, kernels.size, block_, space);
  kernels.construct(block_);

  const Value value =
      parse_json(std::make_shared<SourceFile>(SourceFile{"settings.json", std::string(settings)}), problems_);
  if (problems_.has_errors()) return;
  info().read(block_, value, "block", problems_);
  if (problems_.has_errors()) return;
  info().check(block_, Checker(value, "block", problems_));
  if (problems_.has_errors()) return;
  own_type_ = instance_type(type_, block_);

  for (size_t i = 0; i < info().inputs.size(); ++i) {
    const PortInfo& port = info().inputs[i];
    const bool one = port.shape == PortInfo::Shape::scalar;
    inputs_.emplace_back(one ? 1 : size_t(std::max(0, info().input_length(block_, int(i)))),
                         port.otherwise_value);
  }
  restart();
}

void BlockUnderTest::restart() {
  type_.kernels.prepare(block_, setup_);
  states_.assign(size_t(info().state_length(block_)), 0.0);
  rates_.assign(states_.size(), 0.0);
  crossings_.assign(info().crossings.size(), 0.0);
  memory_.assign(type_.kernels.memory_size / sizeof(std::max_align_t) + 1, {});
  mode_.assign(type_.kernels.mode_size / sizeof(std::max_align_t) + 1, {});
  buffers_.clear();
  for (int i = 0; i < info().buffers; ++i)
    buffers_.emplace_back(size_t(info().buffer_length(block_, i)), 0.0);
  outputs_.assign(info().outputs.size(), {});
  now_ = {};
  fault_ = {};
  connect();
  type_.kernels.start(block_, states_.data(), memory_.data(), buffer_wires_.data(), mode_.data());
}

void BlockUnderTest::tune(std::string_view path, double value) {
  double* number = type_.kernels.tunable(block_, path);
  if (!number) throw std::invalid_argument("there is no tunable " + std::string(path));
  *number = value;
  restart();
}

/// Wires point to the present vectors, which a test may have resized.
void BlockUnderTest::connect() {
  const auto& ports = info().inputs;
  in_.resize(ports.size()), many_.resize(ports.size());
  for (size_t i = 0; i < ports.size(); ++i) {
    in_[i].length = int(inputs_[i].size());
    in_[i].data = inputs_[i].data();
    if (ports[i].shape != PortInfo::Shape::many) continue;
    many_[i].clear();
    for (const double& number : inputs_[i]) many_[i].push_back(&number);
    in_[i].many = many_[i].data();
  }
  out_.resize(outputs_.size());
  for (size_t o = 0; o < outputs_.size(); ++o) {
    const PortInfo& port = info().outputs[o];
    int length = port.shape == PortInfo::Shape::scalar ? 1 : info().output_length(block_, int(o));
    if (length < 0) length = int(inputs_.at(size_t(port.length_of_input)).size());
    outputs_[o].resize(size_t(length));
    out_[o].data = outputs_[o].data(), out_[o].length = length;
  }
  buffer_wires_.resize(buffers_.size());
  for (size_t b = 0; b < buffers_.size(); ++b)
    buffer_wires_[b].data = buffers_[b].data(), buffer_wires_[b].length = int(buffers_[b].size());
  call_ = {};
  call_.block = block_, call_.in = in_.data(), call_.out = out_.data(), call_.buffers = buffer_wires_.data();
  call_.state = states_.data(), call_.rate = rates_.data(), call_.crossing = crossings_.data();
  call_.memory = memory_.data(), call_.mode = mode_.data(), call_.now = &now_, call_.report = &fault_;
}

void BlockUnderTest::call(Step<double> method) {
  if (!block_ || problems_.has_errors())
    throw std::logic_error("the settings have errors:\n" + problems_.text());
  connect();
  if (method) method(call_);
}
void BlockUnderTest::decide() { call(type_.kernels.decide); }
void BlockUnderTest::derivatives() { call(type_.kernels.derivatives); }
void BlockUnderTest::update() { call(type_.kernels.update); }
void BlockUnderTest::accept() { call(type_.kernels.accept); }
void BlockUnderTest::crossings() { call(type_.kernels.crossings); }
bool BlockUnderTest::jump() {
  connect();
  uint64_t jumped = 0;
  call_.jumped = &jumped;
  if (type_.kernels.jump) type_.kernels.jump(call_);
  return jumped != 0;
}
double BlockUnderTest::next_stop(double now) const {
  return info().next_stop ? info().next_stop(block_, now) : infinity;
}

double BlockUnderTest::shortest_period() const {
  return info().shortest_period ? info().shortest_period(block_) : infinity;
}

void BlockUnderTest::compute_outputs() {
  for (int g = 0; g < info().groups; ++g) call(type_.kernels.outputs[g]);
  for (size_t o = 0; o < outputs_.size(); ++o)
    for (size_t k = 0; info().outputs[o].state >= 0 && k < outputs_[o].size(); ++k)
      outputs_[o][k] = states_[size_t(info().outputs[o].state) + k];
}
void BlockUnderTest::evaluate(double time, int64_t tick) {
  now_ = {time, tick};
  decide();
  compute_outputs();
}
void BlockUnderTest::evaluate_held(double time) {
  now_.time = time;
  compute_outputs();
}

void BlockUnderTest::step(double duration) {
  const std::vector<double> before = states_;
  const double begin = now_.time;
  std::vector<double> sum(states_.size(), 0.0);
  const double reach[] = {0.0, 0.5, 0.5, 1.0}, weight[] = {1.0, 2.0, 2.0, 1.0};
  for (int stage = 0; stage < 4; ++stage) {
    now_.time = begin + reach[stage] * duration;
    for (size_t i = 0; i < states_.size(); ++i) states_[i] = before[i] + reach[stage] * duration * rates_[i];
    derivatives();
    for (size_t i = 0; i < states_.size(); ++i) sum[i] += weight[stage] * rates_[i];
  }
  for (size_t i = 0; i < states_.size(); ++i) states_[i] = before[i] + duration / 6.0 * sum[i];
  now_.time = begin + duration;
  accept();
}
void BlockUnderTest::advance(double duration, int steps) {
  for (int i = 0; i < steps; ++i) step(duration / steps);
}
double BlockUnderTest::sample(std::string_view name, double value, std::string_view port) {
  input(name) = value;
  evaluate(double(now_.tick) * setup_.sample_time, now_.tick);
  const double y = output(port);
  update();
  ++now_.tick;
  return y;
}

static bool equal_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}
bool BlockUnderTest::Snapshot::operator==(const Snapshot& other) const {
  return equal_bits(states, other.states) && memory == other.memory && mode == other.mode &&
         std::equal(buffers.begin(), buffers.end(), other.buffers.begin(), other.buffers.end(), equal_bits);
}
BlockUnderTest::Snapshot BlockUnderTest::snapshot() const {
  const auto *memory = reinterpret_cast<const std::byte*>(memory_.data()),
             *mode = reinterpret_cast<const std::byte*>(mode_.data());
  return {states_,
          {memory, memory + type_.kernels.memory_size},
          {mode, mode + type_.kernels.mode_size},
          buffers_};
}
void BlockUnderTest::restore(const Snapshot& snapshot) {
  states_ = snapshot.states, buffers_ = snapshot.buffers;
  std::ranges::copy(snapshot.memory, reinterpret_cast<std::byte*>(memory_.data()));
  std::ranges::copy(snapshot.mode, reinterpret_cast<std::byte*>(mode_.data()));
}

size_t BlockUnderTest::input_of(std::string_view name) const {
  return index_of(info().inputs, name, "input");
}
size_t BlockUnderTest::output_of(std::string_view name) const {
  return index_of(info().outputs, name, "output");
}
size_t BlockUnderTest::state_of(std::string_view name) const {
  const int state = info().outputs[output_of(name)].state;
  if (state < 0) throw std::invalid_argument("the output " + std::string(name) + " is no state");
  return size_t(state);
}
std::vector<double>& BlockUnderTest::inputs(std::string_view name) {
  if (problems_.has_errors()) throw std::logic_error("the settings have errors:\n" + problems_.text());
  return inputs_[input_of(name)];
}
const std::vector<double>& BlockUnderTest::outputs(std::string_view name) const {
  return outputs_.at(output_of(name));
}
double BlockUnderTest::crossing(std::string_view name) const {
  return crossings_.at(index_of(info().crossings, name, "crossing"));
}

}  // namespace loopwright
