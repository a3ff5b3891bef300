/// The loop of a fixed-step run, for one run and for lanes: the same steps and rows, so that both give the
/// same bits.
#pragma once
#include <algorithm>
#include "engine/run/run.h"

namespace loopwright {

/// Steps from the present tick to the plan's stop. `row()` is called at `first_row`, every `record_ticks`
/// after it, and at the stop. No step goes beyond the tick `limit()`. After each step `go_on(was_row)` may
/// end the run. True: the stop was reached.
template <class Real, class Limit, class Row, class GoOn>
bool run_fixed_steps(Run<Real>& run, int64_t first_row, Limit&& limit, Row&& row, GoOn&& go_on) {
  const int64_t stop = run.plan().stop_tick;
  int64_t next_row = first_row;
  for (;;) {
    const int64_t tick = run.now().tick;
    const bool is_row = tick == next_row || tick == stop;
    if (is_row) next_row = std::min(stop, tick + run.plan().record_ticks);
    if (tick == stop) {
      run.evaluate(run.due(), true);
      run.accept();
      row();
      return true;
    }
    run.step_fixed(std::min(next_row, limit()), is_row, row);
    if (!go_on(is_row)) return false;
  }
}

}  // namespace loopwright
