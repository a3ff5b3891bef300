#include "hw/realtime/period.h"
#include <fmt/format.h>
#include <algorithm>
#include "engine/run/fault_text.h"

namespace loopwright::hw {

PeriodStepper::PeriodStepper(const Plan& plan, const Hardware& hardware)
    : hardware_(hardware),
      holds_(hardware.device && hardware.device->policy.on_lost == OnLost::hold),
      run_(plan),
      measured_(hardware.axes.size()),
      before_(hardware.axes.size()) {
  for (const Axis& axis : hardware.axes) {
    positions_.push_back(run_.parameter(axis.path + ".position"));
    velocities_.push_back(run_.parameter(axis.path + ".velocity"));
  }
}

void PeriodStepper::reset() {
  run_.reset({run_.plan().seed, 0});
  std::ranges::fill(measured_, Measured{});
  std::ranges::fill(before_, Measured{});
}

/// Sets the measurement interpolated at this fraction between the previous sample and this one.
void PeriodStepper::set_between(double share) noexcept {
  if (holds_) share = 0;
  for (size_t a = 0; a < measured_.size(); ++a) {
    const Measured &from = before_[a], &to = measured_[a];
    set(a, {from.position + share * (to.position - from.position),
            from.velocity + share * (to.velocity - from.velocity)});
  }
}

void PeriodStepper::set_measured() noexcept {
  for (size_t a = 0; a < measured_.size(); ++a) set(a, before_[a] = measured_[a]);
}

void PeriodStepper::finish() noexcept {
  const Plan& plan = run_.plan();
  const int64_t end = run_.now().tick + hardware_.period_ticks;
  run_.update(due_);
  int64_t next = std::min(end, run_.next_due());
  if (plan.steps_between_samples) next = std::min(next, run_.now().tick + plan.step_ticks);
  run_.integrate(next - run_.now().tick);
  while (run_.now().tick < end) run_.step_fixed(end, false, [] {});  // blocks faster than the period
}

std::string PeriodStepper::fault() const { return fault_text(run_.plan(), run_.fault(), run_.now().time); }

}  // namespace loopwright::hw
