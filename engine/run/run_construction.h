/// Construction of a run: its arena, the calls of its blocks, and its start.
#pragma once
#include "engine/run/run.h"

namespace loopwright {

template <class Real>
Run<Real>::Run(const Plan& plan, int arenas)
    : plan_(plan), arenas_(arenas), wires_(size_t(arenas)), reports_(size_t(arenas * width)) {
  lay_out();
  for (size_t a = 0; a < wires_.size(); ++a)
    base_.push_back(connect(a, wires_[a], x_, [](size_t) { return true; }));
  schedule();
  if (is_fixed_step(plan.method) && plan.states > 0) schedule_stages();
  reset({plan.seed, 0});
}

/// Layout of every arena: signals | x | modes | slopes | x of stages | crossings | buffers | memories.
template <class Real> void Run<Real>::lay_out() {
  const size_t align = std::max<size_t>(64, sizeof(Real));
  const auto reals = [](size_t bytes) { return (bytes + sizeof(Real) - 1) / sizeof(Real); };
  const size_t states = size_t(plan_.states);
  size_t end = size_t(plan_.signals) + states;  // in Reals
  instances_.resize(size_t(arenas_));
  for (auto& instances : instances_)
    for (const Plan::Block& block : plan_.blocks) instances.emplace_back(block);
  for (const BlockInstance<Real>& instance : instances_[0]) {
    mode_at_.push_back(end * sizeof(Real));
    end += reals(instance.mode_bytes());
  }
  evaluated_ = end;
  const size_t slopes = end, stages = slopes + slope_.size() * states,
               crossings = stages + stage_x_.size() * states, buffers = crossings + plan_.crossings.size();
  end = buffers + size_t(plan_.buffer_numbers);
  for (const BlockInstance<Real>& instance : instances_[0]) {
    memory_at_.push_back(end * sizeof(Real));
    end += reals(instance.memory_bytes());
  }
  const size_t bytes = (end * sizeof(Real) + align - 1) / align * align;
  stride_ = ptrdiff_t(bytes / sizeof(Real));
  bytes_ = bytes * size_t(arenas_);
  arena_.reset(static_cast<char*>(::operator new(std::max(bytes_, align), std::align_val_t(64))));
  std::memset(arena_.get(), 0, bytes_);
  numbers_ = reinterpret_cast<Real*>(arena_.get());
  x_ = numbers_ + plan_.signals;
  for (size_t k = 0; k < slope_.size(); ++k) slope_[k] = numbers_ + slopes + k * states;
  for (size_t k = 0; k < stage_x_.size(); ++k) stage_x_[k] = numbers_ + stages + k * states;
  crossing_ = numbers_ + crossings, buffers_ = numbers_ + buffers;
}

/// Calls of the selected blocks. They read their own states and those of other blocks at `states`, a location
/// in the first arena.
template <class Real>
template <class Wanted>
std::vector<Call<Real>> Run<Real>::connect(size_t arena, Wires& wires, Real* states, Wanted&& wanted) {
  size_t ports = 0, many = 0;
  for (size_t b = 0; b < plan_.blocks.size(); ++b) {
    if (!wanted(b)) continue;
    const Plan::Block& block = plan_.blocks[b];
    ports += block.inputs.size() + block.outputs.size() + block.buffer_lengths.size();
    for (const auto& port : block.inputs) many += port.size();
  }
  wires.ports.reserve(ports), wires.many.reserve(many);  // calls point to both
  const ptrdiff_t offset = ptrdiff_t(arena) * stride_;
  char* const bytes = arena_.get() + arena * bytes_ / size_t(arenas_);
  states += offset;
  const auto place = [&](Number n) {
    return n < plan_.signals ? numbers_ + offset + n : states + (n - plan_.signals);
  };
  std::vector<Call<Real>> calls(plan_.blocks.size());
  for (size_t b = 0; b < plan_.blocks.size(); ++b) {
    if (!wanted(b)) continue;
    const Plan::Block& block = plan_.blocks[b];
    Call<Real>& call = calls[b];
    call.block = instances_[arena][b].block(), call.index = int(b), call.now = &now_;
    call.report = reports_.data(), call.jumped = &jumped_, call.first_lane = int(arena) * width;
    call.states = block.states, call.state = states + block.first_state,
    call.rate = slope_[0] + offset + block.first_state,
    call.crossing = crossing_ + offset + block.first_crossing;
    call.memory = bytes + memory_at_[b], call.mode = bytes + mode_at_[b];
    call.in = wires.ports.data() + wires.ports.size();
    for (size_t i = 0; i < block.inputs.size(); ++i) {
      Port<Real> wire{};
      wire.length = int(block.inputs[i].size());
      if (block.type->info.inputs[i].shape == PortInfo::Shape::many) {
        wire.many = wires.many.data() + wires.many.size();
        for (Number n : block.inputs[i]) wires.many.push_back(place(n));
      } else {
        wire.data = block.inputs[i].empty() ? numbers_ + offset : place(block.inputs[i][0]);
      }
      wires.ports.push_back(wire);
    }
    call.out = wires.ports.data() + wires.ports.size();
    for (size_t o = 0; o < block.outputs.size(); ++o) {
      Port<Real> wire{};
      wire.data = place(block.outputs[o]);
      wire.length = block.output_lengths[o];
      wires.ports.push_back(wire);
    }
    call.buffers = wires.ports.data() + wires.ports.size();
    Real* buffer = buffers_ + offset + block.first_buffer;
    for (int length : block.buffer_lengths) {
      Port<Real> wire{};
      wire.data = buffer, wire.length = length;
      wires.ports.push_back(wire);
      buffer += length;
    }
  }
  return calls;
}

template <class Real> uint64_t Run<Real>::mask_of(const Rate& rate) const {
  if (rate.kind == Rate::Kind::continuous) return ~uint64_t(0);
  uint64_t mask = 0;
  for (size_t r = 0; r < plan_.rates.size(); ++r)
    if (plan_.rates[r] == rate) mask |= uint64_t(1) << r;
  return mask;
}

template <class Real>
Call<Real> Run<Real>::call_of(const Plan::Entry& entry, const std::vector<Call<Real>>& base) {
  if (entry.kind == Plan::Entry::Kind::algebraic_loop) {
    auto& loop = algebraic_loops_.emplace_back(std::make_unique<AlgebraicLoopSolver<Real>>());
    const Plan::AlgebraicLoop& plan_loop = plan_.algebraic_loops[size_t(entry.block)];
    std::vector<Call<Real>> calls;
    for (const Plan::Entry& inner : plan_loop.entries) calls.push_back(call_of(inner, base));
    Call<Real> call = base[size_t(plan_loop.entries.front().block)];
    const int arena = call.first_lane / width;
    loop->build(std::move(calls), numbers_ + arena * stride_, plan_loop.tears, call.first_lane);
    call.block = loop.get();
    call.step = &AlgebraicLoopSolver<Real>::step;
    return call;
  }
  Call<Real> call = base[size_t(entry.block)];
  const BlockInstance<Real>& instance = instances_[0][size_t(entry.block)];
  call.step = entry.kind == Plan::Entry::Kind::decide ? instance.decide() : instance.outputs(entry.group);
  return call;
}

/// Interleaves the calls of the arenas. Each arena is two calls behind the previous one, so that short blocks
/// of one arena, which wait for memory, alternate with long blocks of another, which wait for arithmetic.
template <class Real> template <class T> void Run<Real>::take_turns(std::vector<T>& calls) const {
  constexpr size_t behind = 2;
  const size_t arenas = size_t(arenas_), each = calls.size() / arenas;  // still arena by arena
  std::vector<T> turns;
  turns.reserve(calls.size());
  for (size_t turn = 0; turn < each + behind * (arenas - 1); ++turn)
    for (size_t a = 0; a < arenas; ++a)
      if (const size_t i = turn - behind * a; behind * a <= turn && i < each)
        turns.push_back(calls[a * each + i]);
  calls = std::move(turns);
}

template <class Real> void Run<Real>::schedule() {
  gates_.resize(base_.size());
  for (auto& gates : gates_) gates.resize(plan_.gates.size());
  for (const auto& base : base_) schedule_arena(base);
  if (width > 1 && !jumps_.empty()) kept_.resize(evaluated_ * width * size_t(arenas_));
  take_turns(outputs_.all), take_turns(updates_.all), take_turns(between_);
  outputs_.make(plan_.rates.size());
  updates_.make(plan_.rates.size());
}

template <class Real> void Run<Real>::schedule_arena(const std::vector<Call<Real>>& base) {
  using Kind = Plan::Entry::Kind;
  for (const Plan::Entry& entry : plan_.order) {
    const Call<Real> plain = call_of(entry, base);
    const Call<Real> call = conditional(entry, plain, At::decision);
    if (entry.rate.kind == Rate::Kind::constant) {
      constants_.push_back(call);
      continue;
    }
    outputs_.all.emplace_back(mask_of(entry.rate), call);
    if (is_evaluated_early(entry)) early_.push_back(call);
    if (entry.rate.kind != Rate::Kind::continuous) continue;
    if (entry.in_stages || entry.for_events) between_.push_back(call);
    if (entry.kind == Kind::decide) continue;
    const Call<Real> held = conditional(entry, plain, At::step);
    held_.push_back(held);
    if (entry.in_stages) stage_.push_back(held);
    if (entry.for_events) for_events_.push_back(held);
  }
  for (size_t b = 0; b < plan_.blocks.size(); ++b) {
    const Plan::Block& block = plan_.blocks[b];
    const BlockInstance<Real>& instance = instances_[0][b];
    Call<Real> call = base[b];
    if ((call.step = instance.derivatives()))
      slopes_.push_back(conditional(call, Conditional::Kind::slope, block.states));
    if ((call.step = instance.accept())) accepts_.push_back(call);
    if ((call.step = instance.jump())) jumps_.push_back(conditional(call));
    if ((call.step = instance.update()))
      updates_.all.emplace_back(mask_of({Rate::Kind::sampled, block.period, block.offset}),
                                conditional(call));
    if ((call.step = instance.crossings()) && block.first_crossing >= 0)
      crossings_.push_back(
          conditional(call, Conditional::Kind::crossing, int(block.type->info.crossings.size())));
    if constexpr (width == 1)
      if (block.type->info.next_stop && block.period == 0)
        stops_.emplace_back(call.block, block.type->info.next_stop);
  }
}

/// A sampled block that reads inputs is not evaluated before its first sample. A block that reads only memory
/// outputs its memory, and a block without its own sample time is computed from its inputs.
template <class Real> bool Run<Real>::is_evaluated_early(const Plan::Entry& entry) const {
  if (entry.rate.kind != Rate::Kind::sampled || entry.rate.is_due(plan_.start_tick)) return false;
  const auto waits = [&](const Plan::Entry& e) {
    return plan_.blocks[size_t(e.block)].period > 0 && !reads_nothing(e);
  };
  if (entry.kind != Plan::Entry::Kind::algebraic_loop) return !waits(entry);
  return std::ranges::none_of(plan_.algebraic_loops[size_t(entry.block)].entries, waits);
}
template <class Real> bool Run<Real>::reads_nothing(const Plan::Entry& entry) const {
  const BlockInfo& info = plan_.blocks[size_t(entry.block)].type->info;
  if (entry.kind == Plan::Entry::Kind::decide) return info.inputs.empty();
  return std::ranges::none_of(info.outputs, [&](const PortInfo& output) {
    return output.group == entry.group && output.fed_by != 0;
  });
}

template <class Real> double* Run<Real>::parameter(std::string_view path, int lane) {
  for (size_t b = 0; b < plan_.blocks.size(); ++b) {
    const std::string& block = plan_.blocks[b].path;
    if (path.size() > block.size() && path.starts_with(block) && path[block.size()] == '.')
      if (double* found =
              instances_[size_t(lane / width)][b].tunable(path.substr(block.size() + 1), lane % width))
        return found;
  }
  return nullptr;
}

template <class Real> void Run<Real>::reset(const RunIdentity& identity) {
  std::memset(arena_.get(), 0, bytes_);
  move_to(plan_.start_tick);
  forget_faults();
  for (size_t a = 0; a < base_.size(); ++a) {
    for (const auto& [number, value] : plan_.unwired) numbers_[number + ptrdiff_t(a) * stride_] = value;
    for (size_t b = 0; b < plan_.blocks.size(); ++b) {
      const Setup setup{plan_.blocks[b].sample_time, identity.seed, identity.run + int64_t(a) * width,
                        hash_of_path(plan_.blocks[b].path)};
      failed_ |= instances_[a][b].start(base_[a][b], setup);
    }
  }
  run(constants_);
  run(early_);
}

}  // namespace loopwright
