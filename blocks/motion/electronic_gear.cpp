/// slave = ratio · (master - master₀) + slave₀ while it is engaged; else it stands
///
/// When `engage` becomes true, the share of the ratio that acts rises from 0 to 1 as a straight line over
/// `ramp_time`, so that the velocity has no jump; when it becomes false it falls in the same way. In between
/// the slave moves by share · ratio for each change of the master. Once the share is 1, the position is
/// computed from the master's, not added up: no rounding error accumulates. The velocity is the change of the
/// position in the sample, over the sample time, without what a reset changes.
///
/// ratio = numerator / denominator: a ratio of teeth is exact. A rising edge of `reset` sets the slave's
/// position to reset_value.
#include "blocks/logic/truth.h"

namespace loopwright::blocks {

template <class Real> struct ElectronicGear {
  Real numerator, denominator = 1.0, ramp_time = 0.0, initial = 0.0;
  Real ratio, steps;                // steps: samples from standstill to the full ratio
  double time_between_samples = 0;  // s
  struct In {
    Real master, engage, reset, reset_value;
  };
  struct Out {
    Real position, velocity, engaged;
  };
  struct Memory {
    Real slave, master, step, slave_anchor, master_anchor, last_reset, has_begun;
  };
  static constexpr auto describe() {
    using B = ElectronicGear;
    return block(
        "Moves a slave axis in a ratio to a master, engaged without a jump; sampled.",
        parameter(&B::numerator, "numerator", "$position/$master", "Travel of the slave"),
        parameter(&B::denominator, "denominator", "", "For this travel of the master").optional(),
        parameter(&B::ramp_time, "ramp_time", "s", "Time from standstill to the full ratio")
            .not_negative()
            .optional(),
        parameter(&B::initial, "initial", "$position", "Position of the slave at the start").optional(),
        input(&In::master, "master", "$master", "Position of the master"),
        input(&In::engage, "engage", "", "Logic value: engaged while it is true").otherwise(1),
        input(&In::reset, "reset", "", "Logic value whose rising edge sets the slave").otherwise(0),
        input(&In::reset_value, "reset_value", "$position", "Position of the slave after a reset")
            .otherwise(0),
        output(&Out::position, "position", "$position", "Wanted position of the slave"),
        output(&Out::velocity, "velocity", "$position/s", "Its change in a sample, per time")
            .from(&In::master, &In::engage),
        output(&Out::engaged, "engaged", "", "1 while the full ratio acts, else 0").from(&In::engage));
  }
  void check(const Checker& checker) const {
    if (denominator == 0) checker.error("denominator", "the denominator is zero");
  }
  void prepare(double sample_time) {
    ratio = numerator / denominator;
    steps = maximum(round_even(ramp_time / sample_time), Real(1.0));
    time_between_samples = sample_time;
  }
  void start(Memory& memory) const {
    memory = {};
    memory.slave = initial, memory.slave_anchor = initial;
    memory.last_reset = Real(unknown_truth);
  }
  void outputs(const In& in, const Memory& memory, Out& out) const {
    const Memory now = next(in, memory);
    out.position = now.slave;
    out.velocity = select(memory.has_begun > 0.5, travel(in, memory) / time_between_samples, Real(0.0));
    out.engaged = as_number<Real>(next_step(in, memory) >= steps);
  }
  Fault update(const In& in, Memory& memory) const {
    memory = next(in, memory);
    return fault_unless_logic(in.engage, in.reset);
  }

 private:
  /// The share of the ratio in steps. At the first sample an engaged slave is fully engaged: nothing has
  /// moved.
  Real next_step(const In& in, const Memory& memory) const {
    const auto engaged = is_true(in.engage);
    const Real ramped =
        select(engaged, minimum(Real(memory.step + 1.0), steps), maximum(Real(memory.step - 1.0), Real(0.0)));
    return select(memory.has_begun > 0.5, ramped, select(engaged, steps, Real(0.0)));
  }
  Real travel(const In& in, const Memory& memory) const {
    const Real share = 0.5 * (next_step(in, memory) + memory.step) / steps;
    return share * ratio * (in.master - memory.master);
  }
  Memory next(const In& in, const Memory& memory) const {
    Memory now = memory;
    const auto has_begun = memory.has_begun > 0.5;
    now.step = next_step(in, memory);
    const auto stays_engaged = (now.step >= steps) & (memory.step >= steps) & has_begun;
    const Real added = select(has_begun, memory.slave + travel(in, memory), memory.slave);
    now.slave =
        select(stays_engaged, memory.slave_anchor + ratio * (in.master - memory.master_anchor), added);
    const auto resets = is_true(in.reset),
               is_reset = is_edge<Real>(EdgeKind::rising, memory.last_reset, resets);
    now.slave = select(is_reset, in.reset_value, now.slave);
    now.last_reset = as_number<Real>(resets);
    const auto anchors = (!stays_engaged) | is_reset;
    now.slave_anchor = select(anchors, now.slave, memory.slave_anchor);
    now.master_anchor = select(anchors, in.master, memory.master_anchor);
    now.master = in.master, now.has_begun = Real(1.0);
    return now;
  }
};
LOOPWRIGHT_BLOCK(ElectronicGear)

}  // namespace loopwright::blocks
