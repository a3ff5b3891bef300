#include "hw/realtime/period.h"
#include "engine/run/fault_text.h"

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
  if (plan.steps_between_samples) next = std::min(next, run_.now().tick + plan.step_ticks);
  run_.integrate(next - run_.now().tick);
  while (run_.now().tick < end) run_.step_fixed(end, false, [] {});  // what is faster than the period
}

std::string PeriodStepper::fault() const { return fault_text(run_.plan(), run_.fault(), run_.now().time); }

}  // namespace loopwright::hw
