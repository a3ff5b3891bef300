/// A run: all mutable numbers of one simulation in one arena. Run<double> is one simulation, Run<Lanes<8>> eight.
///
/// The step at tick k (docs/architecture.md, tests/engine/run/step_order_test.cpp):
///   1. for every rate due at k, and everything continuous: decisions and outputs, in order
///   2. jumps of states from frozen inputs; if a state changed, 1 again
///   3. accepted memory of continuous blocks; a row of the recording, if one is due
///   4. updates of the rates due, from frozen inputs
///   5. the continuous states advance to the next tick that is due, or by one solver step; sampled signals are held
#pragma once
#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include "engine/plan/plan.h"
#include "engine/run/block_instance.h"
#include "engine/run/ring.h"

namespace loopwright {

/// What tells one run of a plan from another.
struct RunIdentity {
  uint64_t seed = 1;
  int64_t run = 0;  ///< of the first lane
};

template <class Real>
class Run {
 public:
  static constexpr int width = lanes_of<Real>;  ///< simulations in one register

  /// The plan must outlive the run. `registers` arenas stand side by side.
  explicit Run(const Plan& plan, int registers = 1);
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  /// Back to the start with the present parameters.
  void reset(const RunIdentity& identity);
  /// A tunable number by path, "stage.cogging.harmonics.0.amplitude"; null: no such, or structural. Takes effect at reset.
  Real* parameter(std::string_view path, int lane_register = 0);

  // The step, in parts; `step_fixed` is all of it for a fixed-step method.
  /// Rates due now, as a bit mask over Plan::rates.
  uint64_t due() const;
  /// Parts 1 and 2. `everything`: also continuous outputs that only a recording reads.
  void evaluate(uint64_t due_rates, bool everything);
  void accept() { run(accepts_); }
  void update(uint64_t due_rates) { run(updates_.at(due_rates)); }
  /// The next tick after now at which a rate is due.
  int64_t next_due() const;
  /// Part 5 by the plan's fixed-step method.
  void integrate(int64_t ticks);
  void move_to(int64_t tick) { now_ = {plan_.clock.time(tick), tick}; }

  /// One whole step, at most to `limit`; `record()` is called where part 3 says, if `everything`.
  template <class Record>
  void step_fixed(int64_t limit, bool everything, Record&& record) {
    const uint64_t due_rates = due();
    evaluate(due_rates, everything || due_rates != 0);
    accept();
    if (everything) record();
    update(due_rates);
    int64_t next = std::min(limit, now_.tick + plan_.step_ticks);
    if (!plan_.rates.empty()) next = std::min(next, next_due());
    integrate(next - now_.tick);
  }

  // For variable-step solvers: the system between discontinuities, one register.
  bool derivatives_at(double time, const double* x, double* rate);
  bool crossings_at(double time, const double* x, double* value);
  /// States and time as given; signals are not yet computed.
  void look_at(double time, const double* x);
  /// Continuous outputs with modes held, as inside a solver step: those that accepted memory reads, or `everything`.
  void evaluate_held(bool everything) { run(everything ? held_ : for_events_); }
  bool has_accepted_memory() const { return !accepts_.empty(); }
  void set_time(double time) { now_.time = time; }
  /// The next discontinuity in time that a block declares, strictly after `time`.
  double next_stop(double time) const;

  const Real& number(Number n, int lane_register = 0) const { return numbers_[n + lane_register * stride_]; }
  std::span<Real> states() { return {numbers_ + plan_.signals, size_t(plan_.states)}; }
  const Instant& now() const { return now_; }
  const Plan& plan() const { return plan_; }
  uint64_t failed() const { return failed_; }
  const FaultReport& fault() const { return report_; }
  /// Every mutable number: copying it is snapshot, checkpoint and return.
  std::span<char> arena() { return {arena_.get(), bytes_}; }
  /// After the arena was overwritten by a snapshot taken at this tick.
  void restored(int64_t tick) { move_to(tick); failed_ = 0; report_ = {}; }

 private:
  struct FreeArena { void operator()(char* p) const { ::operator delete(p, std::align_val_t(64)); } };

  /// Calls by the set of rates that are due: made once for every set while there are few rates, filtered else.
  struct CallsByRate {
    std::vector<std::pair<uint64_t, Call<Real>>> all;  // mask of rates; ~0: always
    std::vector<std::vector<Call<Real>>> by_due;
    mutable std::vector<Call<Real>> filtered;
    void make(size_t rates) {
      filtered.reserve(all.size());
      if (rates > 6) return;
      by_due.resize(size_t(1) << rates);
      for (size_t due = 0; due < by_due.size(); ++due)
        for (const auto& [mask, call] : all) if (mask == ~uint64_t(0) || (mask & due)) by_due[due].push_back(call);
    }
    const std::vector<Call<Real>>& at(uint64_t due) const {
      if (!by_due.empty()) return by_due[due];
      filtered.clear();
      for (const auto& [mask, call] : all) if (mask == ~uint64_t(0) || (mask & due)) filtered.push_back(call);
      return filtered;
    }
  };

  void lay_out();
  void connect();
  void schedule();
  Call<Real> call_of(const Plan::Entry& entry);
  uint64_t mask_of(const Rate& rate) const;
  LW_INLINE void run(const std::vector<Call<Real>>& calls) {
    uint64_t bad = 0;
    for (const Call<Real>& c : calls) bad |= c.step(c);
    failed_ |= bad;
  }
  template <class F>
  LW_INLINE void each_state(F&& f) {
    for (int r = 0; r < registers_; ++r)
      for (int i = 0; i < plan_.states; ++i) f(r * stride_ + i);
  }
  void euler(double h);
  void heun(double h);
  void rk4(double h);

  const Plan& plan_;
  const int registers_;
  ptrdiff_t stride_ = 0;
  size_t bytes_ = 0;
  std::unique_ptr<char, FreeArena> arena_;
  Real *numbers_ = nullptr, *x_ = nullptr, *rate_ = nullptr, *start_ = nullptr, *sum_ = nullptr, *crossing_ = nullptr, *buffers_ = nullptr;
  std::vector<size_t> memory_at_, mode_at_;  // bytes from the start of the arena
  std::vector<BlockInstance<Real>> instances_;
  std::vector<Port<Real>> wires_;
  std::vector<const Real*> many_;
  std::vector<Call<Real>> base_;  // a block each, without a step
  std::vector<std::unique_ptr<RingSolver<Real>>> rings_;
  std::vector<Call<Real>> constants_, between_, stage_, for_events_, held_, derivatives_, accepts_, jumps_, crossings_;
  CallsByRate outputs_, updates_;
  std::vector<std::pair<const void*, double (*)(const void*, double)>> stops_;
  Instant now_;
  uint64_t failed_ = 0;
  FaultReport report_;
};

// ---- construction ---------------------------------------------------------------------------------------------------

template <class Real>
Run<Real>::Run(const Plan& plan, int registers) : plan_(plan), registers_(registers) {
  lay_out();
  connect();
  schedule();
  reset({plan.seed, 0});
}

/// signals | x | rate | start | sum | crossings | buffers | memories | modes, in every register's arena.
template <class Real>
void Run<Real>::lay_out() {
  const size_t align = std::max<size_t>(64, sizeof(Real));
  const auto up = [](size_t n, size_t a) { return (n + a - 1) / a * a; };
  const size_t states = size_t(plan_.states);
  const size_t reals = size_t(plan_.signals) + 4 * states + plan_.crossings.size() + size_t(plan_.buffer_numbers);
  size_t bytes = reals * sizeof(Real);
  for (const Plan::Block& block : plan_.blocks) {
    instances_.emplace_back(block, registers_);
    const size_t memory = up(instances_.back().memory_bytes(), sizeof(Real)), mode = up(instances_.back().mode_bytes(), sizeof(Real));
    memory_at_.push_back(bytes);
    mode_at_.push_back(bytes + memory);
    bytes += memory + mode;
  }
  bytes = up(bytes, align);
  stride_ = ptrdiff_t(bytes / sizeof(Real));
  bytes_ = bytes * size_t(registers_);
  arena_.reset(static_cast<char*>(::operator new(std::max(bytes_, align), std::align_val_t(64))));
  std::memset(arena_.get(), 0, bytes_);
  numbers_ = reinterpret_cast<Real*>(arena_.get());
  x_ = numbers_ + plan_.signals;
  rate_ = x_ + states, start_ = rate_ + states, sum_ = start_ + states;
  crossing_ = sum_ + states, buffers_ = crossing_ + plan_.crossings.size();
}

template <class Real>
void Run<Real>::connect() {
  size_t wires = 0, many = 0;
  for (const Plan::Block& block : plan_.blocks) {
    wires += block.inputs.size() + block.outputs.size() + block.buffer_lengths.size();
    for (const auto& port : block.inputs) many += port.size();
  }
  wires_.reserve(wires), many_.reserve(many);  // calls point into both
  for (size_t b = 0; b < plan_.blocks.size(); ++b) {
    const Plan::Block& block = plan_.blocks[b];
    Call<Real> call;
    call.block = instances_[b].block(), call.index = int(b), call.now = &now_, call.report = &report_;
    call.registers = registers_, call.stride = stride_;
    call.state = x_ + block.first_state, call.rate = rate_ + block.first_state, call.crossing = crossing_ + block.first_crossing;
    call.memory = arena_.get() + memory_at_[b], call.mode = arena_.get() + mode_at_[b];
    call.in = wires_.data() + wires_.size();
    for (size_t i = 0; i < block.inputs.size(); ++i) {
      Port<Real> wire{};
      wire.length = int(block.inputs[i].size());
      if (block.type->info.inputs[i].shape == PortInfo::Shape::many) {
        wire.many = many_.data() + many_.size();
        for (Number n : block.inputs[i]) many_.push_back(numbers_ + n);
      } else {
        wire.data = block.inputs[i].empty() ? numbers_ : numbers_ + block.inputs[i][0];
      }
      wires_.push_back(wire);
    }
    call.out = wires_.data() + wires_.size();
    for (size_t o = 0; o < block.outputs.size(); ++o) {
      Port<Real> wire{};
      wire.data = numbers_ + block.outputs[o];
      wire.length = block.output_lengths[o];
      wires_.push_back(wire);
    }
    call.buffers = wires_.data() + wires_.size();
    Real* buffer = buffers_ + block.first_buffer;
    for (int length : block.buffer_lengths) {
      Port<Real> wire{};
      wire.data = buffer, wire.length = length;
      wires_.push_back(wire);
      buffer += length;
    }
    base_.push_back(call);
  }
}

template <class Real>
uint64_t Run<Real>::mask_of(const Rate& rate) const {
  if (rate.kind == Rate::Kind::continuous) return ~uint64_t(0);
  uint64_t mask = 0;
  for (size_t r = 0; r < plan_.rates.size(); ++r) if (plan_.rates[r] == rate) mask |= uint64_t(1) << r;
  return mask;
}

template <class Real>
Call<Real> Run<Real>::call_of(const Plan::Entry& entry) {
  if (entry.kind == Plan::Entry::Kind::ring) {
    auto& ring = rings_.emplace_back(std::make_unique<RingSolver<Real>>());
    const Plan::Ring& plan_ring = plan_.rings[size_t(entry.block)];
    std::vector<Call<Real>> calls;
    for (const Plan::Entry& inner : plan_ring.entries) calls.push_back(call_of(inner));
    ring->build(std::move(calls), numbers_, plan_ring.tears);
    Call<Real> call = base_[size_t(plan_ring.entries.front().block)];
    call.block = ring.get();
    call.step = &RingSolver<Real>::step;
    return call;
  }
  Call<Real> call = base_[size_t(entry.block)];
  const BlockInstance<Real>& instance = instances_[size_t(entry.block)];
  call.step = entry.kind == Plan::Entry::Kind::decide ? instance.decide() : instance.outputs(entry.group);
  return call;
}

template <class Real>
void Run<Real>::schedule() {
  using Kind = Plan::Entry::Kind;
  for (const Plan::Entry& entry : plan_.order) {
    const Call<Real> call = call_of(entry);
    if (entry.rate.kind == Rate::Kind::constant) {
      constants_.push_back(call);
      continue;
    }
    outputs_.all.emplace_back(mask_of(entry.rate), call);
    if (entry.rate.kind != Rate::Kind::continuous) continue;
    if (entry.kind != Kind::decide) held_.push_back(call);
    const bool decides = entry.kind == Kind::decide;
    if (entry.in_stages || entry.for_events) between_.push_back(call);
    if (entry.in_stages && !decides) stage_.push_back(call);
    if (entry.for_events && !decides) for_events_.push_back(call);
  }
  for (size_t b = 0; b < plan_.blocks.size(); ++b) {
    const Plan::Block& block = plan_.blocks[b];
    const BlockInstance<Real>& instance = instances_[b];
    Call<Real> call = base_[b];
    if ((call.step = instance.derivatives())) derivatives_.push_back(call);
    if ((call.step = instance.accept())) accepts_.push_back(call);
    if ((call.step = instance.jump())) jumps_.push_back(call);
    if ((call.step = instance.update())) updates_.all.emplace_back(mask_of({Rate::Kind::sampled, block.period, block.offset}), call);
    if ((call.step = instance.crossings()) && block.first_crossing >= 0) crossings_.push_back(call);
    if (block.type->info.next_stop && block.period == 0) stops_.emplace_back(instance.first(), block.type->info.next_stop);
  }
  outputs_.make(plan_.rates.size());
  updates_.make(plan_.rates.size());
}

template <class Real>
Real* Run<Real>::parameter(std::string_view path, int lane_register) {
  for (size_t b = 0; b < plan_.blocks.size(); ++b) {
    const std::string& block = plan_.blocks[b].path;
    if (path.size() > block.size() && path.starts_with(block) && path[block.size()] == '.')
      if (Real* found = instances_[b].tunable(path.substr(block.size() + 1), lane_register)) return found;
  }
  return nullptr;
}

template <class Real>
void Run<Real>::reset(const RunIdentity& identity) {
  std::memset(arena_.get(), 0, bytes_);
  move_to(plan_.start_tick);
  failed_ = 0;
  report_ = {};
  for (int r = 0; r < registers_; ++r)
    for (const auto& [number, value] : plan_.unwired) numbers_[number + r * stride_] = value;
  for (size_t b = 0; b < plan_.blocks.size(); ++b) {
    const Setup setup{plan_.blocks[b].sample_time, identity.seed, identity.run, hash_of_path(plan_.blocks[b].path)};
    instances_[b].start(base_[b], setup);
  }
  run(constants_);
}

// ---- the step -------------------------------------------------------------------------------------------------------

template <class Real>
uint64_t Run<Real>::due() const {
  uint64_t mask = 0;
  for (size_t r = 0; r < plan_.rates.size(); ++r) {
    const Rate& rate = plan_.rates[r];
    mask |= uint64_t(now_.tick >= rate.offset && (now_.tick - rate.offset) % rate.period == 0) << r;
  }
  return mask;
}

template <class Real>
int64_t Run<Real>::next_due() const {
  int64_t next = INT64_MAX;
  for (const Rate& rate : plan_.rates) {
    const int64_t since = now_.tick - rate.offset;
    next = std::min(next, since < 0 ? rate.offset : rate.offset + (since / rate.period + 1) * rate.period);
  }
  return next;
}

template <class Real>
void Run<Real>::evaluate(uint64_t due_rates, bool everything) {
  const auto& calls = everything ? outputs_.at(due_rates) : between_;
  run(calls);
  // A jump changes states that others have read: all signals again, until no state jumps any more.
  for (int i = 0; i < 10 && !jumps_.empty(); ++i) {
    uint64_t changed = 0;
    for (const Call<Real>& c : jumps_) changed |= c.step(c);
    if (!changed) break;
    run(everything ? outputs_.at(due_rates) : between_);
  }
}

template <class Real>
void Run<Real>::integrate(int64_t ticks) {
  const int64_t next = now_.tick + ticks;
  if (plan_.states > 0) {
    const double h = plan_.clock.time(ticks);
    switch (plan_.method) {
      case Method::euler: euler(h); break;
      case Method::heun: heun(h); break;
      default: rk4(h); break;
    }
  }
  move_to(next);
}

template <class Real>
void Run<Real>::euler(double h) {
  run(derivatives_);
  each_state([&](auto i) { x_[i] = x_[i] + Real(h) * rate_[i]; });
}

template <class Real>
void Run<Real>::heun(double h) {
  run(derivatives_);
  each_state([&](auto i) { start_[i] = x_[i]; sum_[i] = rate_[i]; x_[i] = x_[i] + Real(h) * rate_[i]; });
  now_.time += h;
  run(stage_);
  run(derivatives_);
  each_state([&](auto i) { x_[i] = start_[i] + Real(0.5 * h) * (sum_[i] + rate_[i]); });
}

template <class Real>
void Run<Real>::rk4(double h) {
  const double half = 0.5 * h, sixth = h / 6, start = now_.time;
  run(derivatives_);
  each_state([&](auto i) { start_[i] = x_[i]; sum_[i] = rate_[i]; x_[i] = start_[i] + Real(half) * rate_[i]; });
  now_.time = start + half;
  run(stage_);
  run(derivatives_);
  each_state([&](auto i) { sum_[i] = sum_[i] + Real(2.0) * rate_[i]; x_[i] = start_[i] + Real(half) * rate_[i]; });
  run(stage_);
  run(derivatives_);
  each_state([&](auto i) { sum_[i] = sum_[i] + Real(2.0) * rate_[i]; x_[i] = start_[i] + Real(h) * rate_[i]; });
  now_.time = start + h;
  run(stage_);
  run(derivatives_);
  each_state([&](auto i) { x_[i] = start_[i] + Real(sixth) * (sum_[i] + rate_[i]); });
}

// ---- for variable-step solvers ----------------------------------------------------------------------------------------

template <class Real>
bool Run<Real>::derivatives_at(double time, const double* x, double* rate) {
  std::copy_n(x, plan_.states, reinterpret_cast<double*>(x_));
  now_.time = time;
  uint64_t bad = 0;
  for (const Call<Real>& c : stage_) bad |= c.step(c);
  for (const Call<Real>& c : derivatives_) bad |= c.step(c);
  std::copy_n(reinterpret_cast<const double*>(rate_), plan_.states, rate);
  return bad == 0;
}

template <class Real>
bool Run<Real>::crossings_at(double time, const double* x, double* value) {
  std::copy_n(x, plan_.states, reinterpret_cast<double*>(x_));
  now_.time = time;
  uint64_t bad = 0;
  for (const Call<Real>& c : for_events_) bad |= c.step(c);
  for (const Call<Real>& c : crossings_) bad |= c.step(c);
  std::copy_n(reinterpret_cast<const double*>(crossing_), plan_.crossings.size(), value);
  return bad == 0;
}

template <class Real>
void Run<Real>::look_at(double time, const double* x) {
  std::copy_n(x, plan_.states, reinterpret_cast<double*>(x_));
  now_.time = time;
}

template <class Real>
double Run<Real>::next_stop(double time) const {
  double next = infinity;
  for (const auto& [block, stop] : stops_)
    if (const double at = stop(block, time); at > time) next = std::min(next, at);  // stops closer than rounding are none
  return next;
}

}  // namespace loopwright
