/// The loop of a fixed-step run, shared by scalar runs and lanes: the same steps and rows give the same bits.
#pragma once
#include <algorithm>
#include "engine/run/run.h"

namespace loopwright {

/// Whether every row coincides with the end of a step, so that no values inside a step are needed.
inline bool rows_meet_steps(const Plan& plan) {
  if (!plan.steps_between_samples) return true;
  const auto is_whole = [&](int64_t ticks) { return ticks % plan.step_ticks == 0; };
  return is_whole(plan.record_ticks) && std::ranges::all_of(plan.rates, [&](const Rate& rate) {
           return is_whole(rate.period) && is_whole(rate.offset - plan.start_tick);
         });
}

/// Steps from the present tick to the stop of the plan. `row()` is called at `first_row`, every
/// `record_ticks` after it, and at the stop; rows inside a step do not change the step. After each step,
/// `go_on(has_row)` may end the run. Returns true if the stop was reached.
template <class Real, class Row, class GoOn>
bool run_fixed_steps(Run<Real>& run, int64_t first_row, Row&& row, GoOn&& go_on) {
  const Plan& plan = run.plan();
  if (!rows_meet_steps(plan)) run.allow_look_ahead();
  const int64_t stop = plan.stop_tick;
  int64_t next_row = first_row;
  const auto pass_row = [&] { next_row = std::min(stop, next_row + plan.record_ticks); };
  const auto goes_on = [&] { return Run<Real>::width > 1 || !run.failed(); };
  for (;;) {
    const int64_t tick = run.now().tick;
    if (tick == stop) {
      run.evaluate(run.due(), true);
      run.accept();
      row();
      return true;
    }
    bool has_row = tick == next_row;
    if (has_row) pass_row();
    const int64_t next = run.begin_step(plan.steps_between_samples ? stop : next_row, has_row, row);
    for (; next_row < next && goes_on(); pass_row()) {
      run.look_ahead(next_row, row);
      has_row = true;
    }
    run.integrate(next - tick);
    if (!go_on(has_row)) return false;
  }
}

}  // namespace loopwright
