/// Moves several axes to `target` so that all arrive at the same instant: the slowest axis moves as fast as
/// its limits on velocity, acceleration and jerk allow, the others cruise more slowly
///
/// Every axis changes its velocity with its full acceleration and jerk, keeps it, and comes to rest. A new
/// target is followed from the motion that is under way, without a jump. An axis that is already braking for
/// its target cannot come a little later: then all axes take the next time that is possible for each. Without
/// `jerk` velocities are trapezoids. The motion ends exactly at the target; `done` is 1 from then on. A
/// rising edge of `reset` puts all axes at rest at `reset_value`. The target is meant to jump: one that moves
/// continuously needs a sample time here. All axes have one unit; a new target takes some 0.1 ms an axis.
#include "blocks/logic/truth.h"
#include "blocks/motion/several_axes.h"
#include "models/real/whole.h"

namespace loopwright::blocks {

struct SynchronizedMotion : AxisLimits {
  std::vector<double> initial;
  struct In {
    Vector<const double> target;
    double reset;
    Vector<const double> reset_value;
  };
  struct Out {
    Vector<double> position, velocity, acceleration;
    double done;
  };
  struct Mode {
    std::array<PointToPointMotion, most_axes> motions;
    std::array<double, most_axes> phases;
    double start, last_reset;  // start: of the motion, s
  };
  struct Crossings {
    double phase, reset;
  };
  static constexpr auto describe() {
    using B = SynchronizedMotion;
    return block(
        "Moves several axes to a target so that all arrive together, as fast as their limits allow.",
        parameter(&B::velocity, "velocity", "$position/s", "Greatest velocity of each axis").positive(),
        parameter(&B::acceleration, "acceleration", "$position/s^2", "Greatest acceleration of each axis")
            .positive(),
        parameter(&B::jerk, "jerk", "$position/s^3", "Greatest jerk of each axis; trapezoids without it")
            .positive()
            .optional(),
        parameter(&B::initial, "initial", "$position", "Positions at the start, at rest; 0 when left out")
            .optional(),
        input(&In::target, "target", "$position", "Where to go, one number for each axis").length(&B::axes),
        input(&In::reset, "reset", "", "Logic value whose rising edge puts all axes at rest").otherwise(0.0),
        input(&In::reset_value, "reset_value", "$position", "Where they are at rest after a reset")
            .length(&B::axes)
            .otherwise(0.0),
        output(&Out::position, "position", "$position", "Wanted positions")
            .length(&B::axes)
            .from(&In::reset, &In::reset_value),
        output(&Out::velocity, "velocity", "$position/s", "Wanted velocities")
            .length(&B::axes)
            .from(&In::reset),
        output(&Out::acceleration, "acceleration", "$position/s^2", "Wanted accelerations").length(&B::axes),
        output(&Out::done, "done", "", "1 at rest at the target, else 0").from(&In::target, &In::reset),
        crossing(&Crossings::phase, "phase"), crossing(&Crossings::reset, "reset"));
  }
  int axes() const { return int(velocity.size()); }
  void check(const Checker& checker) const {
    check_limits(checker, *this);
    if (!initial.empty()) check_axes(checker, "initial", initial.size(), velocity.size());
  }
  void start(Mode& mode) const {
    mode = {};
    for (size_t i = 0; i < velocity.size(); ++i)
      mode.motions[i] = PointToPointMotion::at_rest(initial.empty() ? 0 : initial[i]);
    mode.phases.fill(PointToPointMotion::phases);
    mode.last_reset = unknown_truth;
  }
  Fault decide(const Instant& now, const In& in, Mode& mode) const {
    const bool reset = is_true(in.reset),
               is_reset = is_edge<double>(EdgeKind::rising, mode.last_reset, reset);
    mode.last_reset = as_number<double>(reset);
    bool is_new = is_reset, is_finite = true;
    for (size_t i = 0; i < velocity.size(); ++i) {
      is_new |= in.target[i] != mode.motions[i].target();
      is_finite &= std::isfinite(in.target[i]);
    }
    if (is_new && is_finite) is_finite = move(now, in, is_reset, mode);
    for (size_t i = 0; i < velocity.size(); ++i)
      mode.phases[i] = mode.motions[i].phase_at(now.time - mode.start);
    if (const Fault fault = fault_unless_logic(in.reset); fault.lanes) return fault;
    return fault_if(!is_finite, "there is no finite motion to this target");
  }
  void outputs(const Instant& now, const Mode& mode, Out& out) const {
    bool done = true;
    for (size_t i = 0; i < velocity.size(); ++i) {
      const int phase = phase_of(mode, i);
      const MotionState state = mode.motions[i].state_at(now.time - mode.start, phase);
      out.position[i] = state.position, out.velocity[i] = state.velocity;
      out.acceleration[i] = state.acceleration;
      done &= phase == PointToPointMotion::phases;
    }
    out.done = as_number<double>(done);
  }
  void crossings(const Instant& now, const In& in, const Mode& mode, Crossings& value) const {
    double left = 1e300;
    for (size_t i = 0; i < velocity.size(); ++i) {
      left = std::min(left, mode.motions[i].end_of_phase(phase_of(mode, i)) - (now.time - mode.start));
      if (in.target[i] != mode.motions[i].target()) left = -1;
    }
    value.phase = above_zero(left);
    value.reset = truth_crossing(in.reset);
  }

 private:
  static int phase_of(const Mode& mode, size_t axis) {
    return whole_between(mode.phases[axis], 0, PointToPointMotion::phases);
  }
  /// Whether there is a motion.
  bool move(const Instant& now, const In& in, bool is_reset, Mode& mode) const {
    boost::container::static_vector<TimedMotion, most_axes> moving;
    for (size_t i = 0; i < velocity.size(); ++i) {
      const MotionState from =
          is_reset ? MotionState{in.reset_value[i], 0, 0} : mode.motions[i].state_at(now.time - mode.start);
      moving.emplace_back(from, in.target[i], 0, of_axis(i));
    }
    const CommonMotion common = common_motion({moving.data(), moving.size()});
    if (!std::isfinite(common.duration)) return false;
    for (size_t i = 0; i < moving.size(); ++i)
      mode.motions[i] = moving[i].motion(common.duration, common.cruises[i]);
    mode.start = now.time;
    return true;
  }
};
LOOPWRIGHT_BLOCK(SynchronizedMotion)

}  // namespace loopwright::blocks
