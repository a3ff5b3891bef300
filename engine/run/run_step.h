/// The computations of a run in a step: signals in order, and functions for a variable-step solver.
#pragma once
#include "engine/run/run.h"

namespace loopwright {

template <class Real> uint64_t Run<Real>::due() const {
  if (now_.tick < none_due_before_) return 0;
  uint64_t mask = 0;
  for (size_t r = 0; r < plan_.rates.size(); ++r) mask |= uint64_t(plan_.rates[r].is_due(now_.tick)) << r;
  return mask;
}

template <class Real> int64_t Run<Real>::next_due() {
  if (now_.tick < none_due_before_) return none_due_before_;
  int64_t next = INT64_MAX;
  for (const Rate& rate : plan_.rates) {
    const int64_t since = now_.tick - rate.offset;
    next = std::min(next, since < 0 ? rate.offset : rate.offset + (since / rate.period + 1) * rate.period);
  }
  return none_due_before_ = next;
}

template <class Real> void Run<Real>::evaluate(uint64_t due_rates, bool everything) {
  const auto& calls = everything ? outputs_.at(due_rates) : between_;
  run(calls);
  if (!jumps_.empty()) repeat_after_jumps(calls);
}

/// A jump changes states that other blocks have read. All signals are computed again until no state jumps. A
/// block that still jumps after the maximum number of repetitions is reported.
template <class Real> void Run<Real>::repeat_after_jumps(const std::vector<Call<Real>>& calls) {
  constexpr int most = 10;
  for (int round = 0;; ++round) {
    uint64_t changed = 0;
    for (const Call<Real>& c : jumps_) {
      jumped_ = 0;
      failed_ |= c.step(c);
      jumped_ &= ~failed_;
      if (jumped_ && round == most)
        failed_ |= report_fault(reports_.data(), c.index,
                                {jumped_, "its states jump again and again at this instant, without an end"});
      changed |= jumped_;
    }
    if (!changed || round == most) break;
    if constexpr (width == 1)
      run(calls);
    else
      evaluate_again(changed, calls);
  }
}

template <class Real> void Run<Real>::evaluate_again(uint64_t jumped, const std::vector<Call<Real>>& calls) {
  // A lane without a jump must not decide twice: its modes and signals are restored.
  const size_t count = evaluated_ * width;
  const auto numbers_of = [&](int a) { return reinterpret_cast<double*>(numbers_ + a * stride_); };
  for (int a = 0; a < arenas_; ++a)
    std::memcpy(&kept_[size_t(a) * count], numbers_of(a), count * sizeof(double));
  run(calls);
  for (int a = 0; a < arenas_; ++a)
    for (size_t i = 0; i < count; ++i)
      if (!(jumped >> (size_t(a) * width + i % width) & 1))
        std::memcpy(numbers_of(a) + i, &kept_[size_t(a) * count + i], sizeof(double));
}

template <class Real> void Run<Real>::keep_numbers() {
  for (size_t a = 0; a < base_.size(); ++a)
    std::copy_n(numbers_ + ptrdiff_t(a) * stride_, number_count(), &ahead_[a * number_count()]);
}
template <class Real> void Run<Real>::put_numbers_back() {
  for (size_t a = 0; a < base_.size(); ++a)
    std::copy_n(&ahead_[a * number_count()], number_count(), numbers_ + ptrdiff_t(a) * stride_);
}

template <class Real> template <class Record> void Run<Real>::look_ahead(int64_t tick, Record&& record) {
  const Instant now = now_;
  keep_numbers();
  integrate(tick - now_.tick);
  run(held_);
  record();
  put_numbers_back();
  now_ = now;
}

// Between discontinuities, for variable-step solvers.

template <class Real>
template <class Record>
void Run<Real>::look_between(double time, const double* x, Record&& record) {
  keep_numbers();
  look_at(time, x);
  run(held_);
  record();
  put_numbers_back();
}

template <class Real> bool Run<Real>::derivatives_at(double time, const double* x, double* rate) {
  const bool are_current = signals_are_current_ && time == now_.time && std::equal(x, x + plan_.states, x_);
  signals_are_current_ = false;
  uint64_t bad = 0;
  if (!are_current) {
    look_at(time, x);
    forget_trials();
    for (const Call<Real>& c : stage_) bad |= c.step(c);
  }
  for (const Call<Real>& c : slopes_) bad |= c.step(c);
  copy_states(slope_[0], size_t(plan_.states), rate);
  return bad == 0;
}

template <class Real> void Run<Real>::leave_out(const std::vector<bool>& blocks) {
  if (whole_stage_.empty()) whole_between_ = between_, whole_stage_ = stage_;
  const auto leave_out_of = [&](const std::vector<Call<Real>>& whole, std::vector<Call<Real>>& calls) {
    calls.clear();
    std::ranges::copy_if(whole, std::back_inserter(calls),
                         [&](const Call<Real>& c) { return !blocks[size_t(c.index)]; });
  };
  leave_out_of(whole_between_, between_), leave_out_of(whole_stage_, stage_);
  signals_are_current_ = false;
}

template <class Real> bool Run<Real>::crossings_at(double time, const double* x, double* value) {
  look_at(time, x);
  forget_trials();
  uint64_t bad = 0;
  for (const Call<Real>& c : for_events_) bad |= c.step(c);
  for (const Call<Real>& c : crossings_) bad |= c.step(c);
  std::copy_n(crossing_, plan_.crossings.size(), value);
  return bad == 0;
}

template <class Real> void Run<Real>::look_at(double time, const double* x) {
  signals_are_current_ = false;
  copy_states(x, size_t(plan_.states), x_);
  now_.time = time;
}

template <class Real> double Run<Real>::next_stop(double time) const {
  double next = infinity;
  for (const auto& [block, stop] : stops_)
    if (const double at = stop(block, time); at > time)
      next = std::min(next, at);  // stops closer than rounding are ignored
  return next;
}

}  // namespace loopwright
