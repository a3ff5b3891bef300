/// The fastest motion to `target` within limits on velocity, acceleration and jerk: seven phases of constant
/// jerk, or without `jerk` a trapezoid of velocity
///
/// A new target is followed from the motion that is under way, without a jump. The motion ends exactly at the
/// target; `done` is 1 from then on. A rising edge of `reset` puts it at rest at `reset_value`, as after
/// homing. The target is meant to jump: one that moves continuously needs a sample time here. Without one,
/// the borders of the phases are events for a variable-step solver.
#include "blocks/logic/truth.h"
#include "models/motion/point_to_point.h"
#include "models/real/whole.h"

namespace loopwright::blocks {

struct PointToPoint {
  double velocity, acceleration, jerk = infinity, initial = 0;
  struct In {
    double target, reset, reset_value;
  };
  struct Out {
    double position, velocity, acceleration, done;
  };
  struct Mode {
    PointToPointMotion motion;
    double start, phase, last_reset;  // start: of the motion, s
  };
  struct Crossings {
    double above, below, phase, reset;
  };
  static constexpr auto describe() {
    using B = PointToPoint;
    return block(
        "The fastest motion to a target within limits on velocity, acceleration and jerk.",
        parameter(&B::velocity, "velocity", "$position/s", "Greatest velocity").positive(),
        parameter(&B::acceleration, "acceleration", "$position/s^2", "Greatest acceleration").positive(),
        parameter(&B::jerk, "jerk", "$position/s^3", "Greatest jerk; a trapezoid without it")
            .positive()
            .optional(),
        parameter(&B::initial, "initial", "$position", "Position at the start, at rest").optional(),
        input(&In::target, "target", "$position", "Where to go"),
        input(&In::reset, "reset", "", "Logic value whose rising edge puts it at rest").otherwise(0.0),
        input(&In::reset_value, "reset_value", "$position", "Where it is at rest after a reset")
            .otherwise(0.0),
        output(&Out::position, "position", "$position", "Wanted position").from(&In::reset, &In::reset_value),
        output(&Out::velocity, "velocity", "$position/s", "Wanted velocity").from(&In::reset),
        output(&Out::acceleration, "acceleration", "$position/s^2", "Wanted acceleration"),
        output(&Out::done, "done", "", "1 at rest at the target, else 0").from(&In::target, &In::reset),
        crossing(&Crossings::above, "above"), crossing(&Crossings::below, "below"),
        crossing(&Crossings::phase, "phase"), crossing(&Crossings::reset, "reset"));
  }
  void start(Mode& mode) const {
    mode = {};
    mode.motion = PointToPointMotion::at_rest(initial);
    mode.phase = PointToPointMotion::phases, mode.last_reset = unknown_truth;
  }
  Fault decide(const Instant& now, const In& in, Mode& mode) const {
    const bool reset = is_true(in.reset),
               is_reset = is_edge<double>(EdgeKind::rising, mode.last_reset, reset);
    mode.last_reset = as_number<double>(reset);
    if (is_reset || in.target != mode.motion.target()) {
      const MotionState from =
          is_reset ? MotionState{in.reset_value, 0, 0} : mode.motion.state_at(now.time - mode.start);
      mode.motion = PointToPointMotion::between(from, in.target, {velocity, acceleration, jerk});
      mode.start = now.time;
    }
    mode.phase = mode.motion.phase_at(now.time - mode.start);
    if (const Fault fault = fault_unless_logic(in.reset); fault.lanes) return fault;
    return fault_if(!std::isfinite(in.target) || !std::isfinite(mode.motion.duration()),
                    "there is no finite motion to this target");
  }
  void outputs(const Instant& now, const Mode& mode, Out& out) const {
    const int phase = phase_of(mode);
    const MotionState state = mode.motion.state_at(now.time - mode.start, phase);
    out.position = state.position, out.velocity = state.velocity, out.acceleration = state.acceleration;
    out.done = as_number<double>(phase == PointToPointMotion::phases);
  }
  void crossings(const Instant& now, const In& in, const Mode& mode, Crossings& value) const {
    value.above = above_zero(in.target - mode.motion.target());
    value.below = not_below_zero(in.target - mode.motion.target());
    value.reset = truth_crossing(in.reset);
    const double left = mode.motion.end_of_phase(phase_of(mode)) - (now.time - mode.start);
    value.phase = above_zero(std::min(left, 1e300));
  }

 private:
  static int phase_of(const Mode& mode) { return whole_between(mode.phase, 0, PointToPointMotion::phases); }
};
LOOPWRIGHT_BLOCK(PointToPoint)

}  // namespace loopwright::blocks
