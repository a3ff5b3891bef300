#include "hw/realtime/period.h"
#include <fmt/format.h>

namespace loopwright::hw {

PeriodStepper::PeriodStepper(const Plan& plan, const Hardware& hardware) : hardware_(hardware), run_(plan) {
  for (const Axis& axis : hardware.axes) {
    positions_.push_back(run_.parameter(axis.path + ".position"));
    velocities_.push_back(run_.parameter(axis.path + ".velocity"));
  }
}

void PeriodStepper::finish() noexcept {
  const Plan& plan = run_.plan();
  const int64_t end = run_.now().tick + hardware_.period_ticks;
  run_.update(due_);
  int64_t next = std::min(end, run_.next_due());
  if (plan.states > 0) next = std::min(next, run_.now().tick + plan.step_ticks);
  run_.integrate(next - run_.now().tick);
  while (run_.now().tick < end) run_.step_fixed(end, false, [] {});  // what is faster than the period
}

std::string PeriodStepper::fault() const {
  const FaultReport& fault = run_.fault();
  return fmt::format("\"{}\" stopped the run at t = {:g} s: {}",
                     fault.block < 0 ? "?" : run_.plan().blocks[size_t(fault.block)].path, run_.now().time,
                     fault.reason);
}

}  // namespace loopwright::hw
