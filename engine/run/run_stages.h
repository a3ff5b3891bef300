/// Fixed-step methods. Every stage of a step has its own states. A block that has computed its slope
/// immediately writes its states of the next stage, while the slope is in registers. No other block loses the
/// states that it still has to read.
#pragma once
#include "engine/run/run.h"

namespace loopwright {

/// Blocks with states, and the blocks whose outputs the slopes need.
template <class Real> std::vector<bool> Run<Real>::blocks_in_stages() const {
  std::vector<bool> found(plan_.blocks.size(), false);
  for (const Plan::Entry& entry : plan_.order) {
    if (!entry.in_stages) continue;
    if (entry.kind != Plan::Entry::Kind::algebraic_loop)
      found[size_t(entry.block)] = true;
    else
      for (const Plan::Entry& inner : plan_.algebraic_loops[size_t(entry.block)].entries)
        found[size_t(inner.block)] = true;
  }
  for (size_t b = 0; b < found.size(); ++b)
    if (plan_.blocks[b].states > 0) found[b] = true;
  return found;
}

/// The signals of the first stage are already computed; it reads the states at their usual location.
template <class Real> void Run<Real>::schedule_stages() {
  const size_t stages = plan_.method == Method::rk4 ? 4 : plan_.method == Method::heun ? 2 : 1;
  const std::vector<bool> is_in_stages = blocks_in_stages();
  stage_of_.reserve(stages * size_t(plan_.states) * base_.size());  // calls point to it
  stage_wires_.resize(base_.size());
  for (size_t a = 0; a < base_.size(); ++a) {
    std::array<std::vector<Call<Real>>, 2> moved;
    for (size_t k = 0; k < moved.size() && k + 1 < stages; ++k)
      moved[k] = connect(a, stage_wires_[a][k], stage_x_[k], [&](size_t b) { return is_in_stages[b]; });
    for (size_t k = 0; k < stages; ++k) schedule_stage(k, stages, k == 0 ? base_[a] : moved[(k - 1) % 2]);
  }
  take_turns(stages_);
}

/// Each stage has its own time, as the arenas are not all in the same stage.
template <class Real>
void Run<Real>::schedule_stage(size_t stage, size_t stages, std::vector<Call<Real>> base) {
  for (Call<Real>& call : base) call.now = &stage_now_[stage];
  for (const Plan::Entry& entry : plan_.order)
    if (stage > 0 && entry.in_stages && entry.kind != Plan::Entry::Kind::decide)
      stages_.push_back(conditional(entry, call_of(entry, base), At::step));
  for (size_t b = 0; b < plan_.blocks.size(); ++b)
    if (instances_[0][b].derivatives()) stages_.push_back(slope_call(base[b], stage, stage + 1 == stages));
}

template <class Real> Call<Real> Run<Real>::slope_call(Call<Real> call, size_t stage, bool is_last) {
  const ptrdiff_t first = call.first_lane / width * stride_ + plan_.blocks[size_t(call.index)].first_state;
  const BlockInstance<Real>& instance = instances_[0][size_t(call.index)];
  call.rate = slope_[stage] + first;
  if (is_last && plan_.method != Method::rk4) {
    call.step = instance.derivatives();
  } else {
    call.step = is_last ? instance.to_next_step() : instance.to_next_stage();
    Real* const next = is_last ? x_ : stage_x_[stage % 2];
    call.stage =
        &stage_of_.emplace_back(Stage<Real>{x_ + first,
                                            next + first,
                                            {slope_[0] + first, slope_[1] + first, slope_[2] + first},
                                            &weight_[stage]});
  }
  return conditional(call, Conditional::Kind::slope, call.states);
}

template <class Real> void Run<Real>::integrate(int64_t ticks) {
  const int64_t next = now_.tick + ticks;
  if (plan_.states > 0) {
    const double h = plan_.clock.time(ticks);
    switch (plan_.method) {
      case Method::euler:
        euler(h);
        break;
      case Method::heun:
        heun(h);
        break;
      default:
        rk4(h);
        break;
    }
  }
  move_to(next);
}

/// x + h k.
template <class Real> void Run<Real>::euler(double h) {
  stage_now_ = {now_};
  run(stages_);
  each_state([&](auto i) __attribute__((always_inline)) { x_[i] = x_[i] + Real(h) * slope_[0][i]; });
}

/// k₂ at x + h k₁; x + h/2 (k₁ + k₂).
template <class Real> void Run<Real>::heun(double h) {
  const auto [k1, k2, k3, k4] = slope_;
  weight_ = {h};
  stage_now_ = {now_, after(h)};
  run(stages_);
  each_state([&](auto i) __attribute__((always_inline)) { x_[i] = x_[i] + Real(0.5 * h) * (k1[i] + k2[i]); });
}

/// k₂ at x + h/2 k₁, k₃ at x + h/2 k₂, k₄ at x + h k₃; x + h/6 (k₁ + 2 k₂ + 2 k₃ + k₄).
template <class Real> void Run<Real>::rk4(double h) {
  weight_ = {0.5 * h, 0.5 * h, h, h / 6};
  stage_now_ = {now_, after(0.5 * h), after(0.5 * h), after(h)};
  run(stages_);
}

}  // namespace loopwright
