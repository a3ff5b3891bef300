/// Moves several axes through `points`: all axes pass a point at the same instant, and are at rest at the
/// first and the last one
///
/// The velocities at the points are searched for before the run, so that the whole motion becomes short
/// within the limits on velocity, acceleration and jerk of each axis; it is never longer than with a stop at
/// every point. An axis has no acceleration at a point, no velocity where it turns round, and does not move
/// back in between. Between two points every axis changes its velocity with its full acceleration and jerk,
/// keeps it, and changes it again. Without `jerk` velocities are trapezoids. The search takes milliseconds to
/// seconds, more with many points and axes.
///
/// The motion begins at a rising edge of `run`, or at the start if it is true there. A rising edge of `reset`
/// puts all axes back at the first point, at rest. All axes have one unit.
#include "blocks/logic/truth.h"
#include "blocks/motion/several_axes.h"
#include "models/motion/via_points.h"
#include "models/real/whole.h"

namespace loopwright::blocks {

struct ViaPoints : AxisLimits {
  std::vector<std::vector<double>> points;
  ViaPointMotion motion{};
  struct In {
    double run, reset;
  };
  struct Out {
    Vector<double> position, velocity, acceleration;
    double point, done;
  };
  struct Mode {
    std::array<double, most_axes> phases;
    double part;   // between points; -1: waits at the first one
    double start;  // of the motion, s
    double last_run, last_reset;
  };
  struct Crossings {
    double phase, run, reset;
  };
  static constexpr auto describe() {
    using B = ViaPoints;
    return block(
        "Moves several axes through a list of points, without stopping there, as fast as their limits allow.",
        parameter(&B::points, "points", "$position", "The points, each with a number for each axis"),
        parameter(&B::velocity, "velocity", "$position/s", "Greatest velocity of each axis").positive(),
        parameter(&B::acceleration, "acceleration", "$position/s^2", "Greatest acceleration of each axis")
            .positive(),
        parameter(&B::jerk, "jerk", "$position/s^3", "Greatest jerk of each axis; trapezoids without it")
            .positive()
            .optional(),
        input(&In::run, "run", "", "Logic value whose rising edge begins the motion").otherwise(1.0),
        input(&In::reset, "reset", "", "Logic value whose rising edge leads back to the first point")
            .otherwise(0.0),
        output(&Out::position, "position", "$position", "Wanted positions").length(&B::axes).from(&In::reset),
        output(&Out::velocity, "velocity", "$position/s", "Wanted velocities")
            .length(&B::axes)
            .from(&In::reset),
        output(&Out::acceleration, "acceleration", "$position/s^2", "Wanted accelerations").length(&B::axes),
        output(&Out::point, "point", "", "The last point that was passed, counted from 0").from(&In::reset),
        output(&Out::done, "done", "", "1 at rest at the last point, else 0").from(&In::reset),
        crossing(&Crossings::phase, "phase"), crossing(&Crossings::run, "run"),
        crossing(&Crossings::reset, "reset"));
  }
  int axes() const { return int(velocity.size()); }
  void check(const Checker& checker) const {
    constexpr size_t most_points = 50;  // for the time of the search
    check_limits(checker, *this);
    if (points.size() < 2 || points.size() > most_points) {
      auto& problem = checker.error("points", "the number of points is not possible");
      problem.expected = "2 to " + std::to_string(most_points) + " points, as in [[0, 0], [0.1, 0.05]]";
      problem.found = std::to_string(points.size());
    }
    for (const std::vector<double>& point : points)
      if (point.size() != velocity.size())
        return check_axes(checker, "points", point.size(), velocity.size());
  }
  Fault prepare(double) {
    motion = ViaPointMotion(points, of_each());
    return fault_if(!std::isfinite(motion.duration()), "there is no finite motion through these points");
  }
  void start(Mode& mode) const {
    mode = {};
    mode.part = -1, mode.last_run = 0, mode.last_reset = unknown_truth;
  }
  Fault decide(const Instant& now, const In& in, Mode& mode) const {
    const bool run = is_true(in.run), reset = is_true(in.reset);
    const bool is_reset = is_edge<double>(EdgeKind::rising, mode.last_reset, reset);
    const bool begins = is_edge<double>(EdgeKind::rising, mode.last_run, run);
    mode.last_run = as_number<double>(run), mode.last_reset = as_number<double>(reset);
    if (is_reset) mode.part = -1;
    if (begins && mode.part < 0) mode.part = 0, mode.start = now.time;
    if (mode.part >= 0) {
      const size_t part = motion.part_at(now.time - mode.start);
      mode.part = double(part);
      for (size_t i = 0; part < motion.parts() && i < velocity.size(); ++i)
        mode.phases[i] = motion.motion(part, i).phase_at(now.time - mode.start - motion.begin_of(part));
    }
    if (const Fault fault = fault_unless_logic(in.run); fault.lanes) return fault;
    return fault_unless_logic(in.reset);
  }
  void outputs(const Instant& now, const Mode& mode, Out& out) const {
    const int parts = int(motion.parts()), part = whole_between(mode.part, -1, parts);
    for (size_t i = 0; i < velocity.size(); ++i) {
      MotionState state{part < 0 ? points.front()[i] : points.back()[i], 0, 0};
      if (part >= 0 && part < parts)
        state = motion.motion(size_t(part), i)
                    .state_at(now.time - mode.start - motion.begin_of(size_t(part)), phase_of(mode, i));
      out.position[i] = state.position, out.velocity[i] = state.velocity;
      out.acceleration[i] = state.acceleration;
    }
    out.point = std::max(part, 0);
    out.done = as_number<double>(part == parts);
  }
  void crossings(const Instant& now, const In& in, const Mode& mode, Crossings& value) const {
    const int parts = int(motion.parts()), part = whole_between(mode.part, -1, parts);
    double left = 1e300;
    if (part >= 0 && part < parts) {
      // The same differences as those that decide which part and which phase it is.
      const double time = now.time - mode.start, in_part = time - motion.begin_of(size_t(part));
      left = motion.begin_of(size_t(part) + 1) - time;
      for (size_t i = 0; i < velocity.size(); ++i)
        left = std::min(left, motion.motion(size_t(part), i).end_of_phase(phase_of(mode, i)) - in_part);
    }
    value.phase = above_zero(left);
    value.run = truth_crossing(in.run), value.reset = truth_crossing(in.reset);
  }

 private:
  static int phase_of(const Mode& mode, size_t axis) {
    return whole_between(mode.phases[axis], 0, PointToPointMotion::phases);
  }
};
LOOPWRIGHT_BLOCK(ViaPoints)

}  // namespace loopwright::blocks
