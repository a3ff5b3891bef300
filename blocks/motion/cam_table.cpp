/// The position of a slave over that of a master: a cubic spline through points
///
/// y = S(x), v = S'(x) x', a = S''(x) x'² + S'(x) x''. The spline and its first two derivatives are
/// continuous (C. de Boor, A Practical Guide to Splines, 1978, chapter IV). Its ends: "periodic" joins the
/// last point to the first one, "at_rest" has the slope 0 there, "natural" the second derivative 0,
/// "not_a_knot" one cubic between the three outermost points.
///
/// "cyclic" repeats the table for ever, in both directions: each cycle of the master begins where the last
/// one ended, the last point takes the place of the first. A cam that comes back has equal first and last
/// values; one that does not, such as a feeder, adds the difference at every cycle. Without "cyclic" the ends
/// are held. Where the table ends or begins again is an event for a variable-step solver, unless it is
/// periodic.
#include <algorithm>
#include "blocks/math/sides.h"
#include "models/motion/cubic_spline.h"

namespace loopwright::blocks {

struct CamTable {
  std::vector<double> master, slave;
  SplineEnds ends = SplineEnds::at_rest;
  bool cyclic = false;
  CubicSpline spline;
  struct In {
    double master, master_velocity, master_acceleration;
  };
  struct Out {
    double position, velocity, acceleration;
  };
  struct Crossings {
    double first, last;
  };
  static constexpr auto describe() {
    return block(
        "Moves a slave axis by a table over the position of a master, smoothly.",
        parameter(&CamTable::master, "master", "$master", "Positions of the master, rising"),
        parameter(&CamTable::slave, "slave", "$position", "Position of the slave at each of them"),
        parameter(&CamTable::ends, "ends", "", "How the spline begins and ends").optional(),
        parameter(&CamTable::cyclic, "cyclic", "", "Whether the table is repeated").optional(),
        input(&In::master, "position", "$master", "Position of the master"),
        input(&In::master_velocity, "velocity", "$master/s", "Its velocity").otherwise(0),
        input(&In::master_acceleration, "acceleration", "$master/s^2", "Its acceleration").otherwise(0),
        output(&Out::position, "slave_position", "$position", "Wanted position of the slave")
            .from(&In::master),
        output(&Out::velocity, "slave_velocity", "$position/s", "Its velocity")
            .from(&In::master, &In::master_velocity),
        output(&Out::acceleration, "slave_acceleration", "$position/s^2", "Its acceleration"),
        crossing(&Crossings::first, "first"), crossing(&Crossings::last, "last"));
  }
  void check(const Checker& checker) const {
    if (master.size() < 2) checker.error("master", "a cam needs two points or more");
    for (size_t i = 1; i < master.size(); ++i)
      if (!(master[i] > master[i - 1])) {
        checker.error("master", "the positions of the master do not rise").found =
            "point " + std::to_string(i + 1) + " is not above the one before";
        break;
      }
    if (slave.size() != master.size())
      checker.error("slave", "the positions of the slave do not fit those of the master").expected =
          std::to_string(master.size()) + " numbers";
    else if (ends == SplineEnds::periodic && !cyclic)
      checker.error("ends", "a table with periodic ends is repeated").hint = "\"cyclic\": true";
  }
  void prepare(double) { spline = CubicSpline(master, slave, ends); }
  Fault outputs(const In& in, Out& out) const {
    double x = in.master, cycles = 0, moves = 1;
    if (cyclic) {
      cycles = std::floor(turns(x));
      x -= cycles * period();
    } else if (x < master.front() || x > master.back()) {
      x = std::clamp(x, master.front(), master.back()), moves = 0;
    }
    const SplinePoint at = spline.at(x);
    const double v = moves * in.master_velocity, a = moves * in.master_acceleration;
    out.position = at.value + cycles * (slave.back() - slave.front());
    out.velocity = at.slope * v;
    out.acceleration = at.bend * v * v + at.slope * a;
    return fault_if(!std::isfinite(in.master), "the position of the master is not a number");
  }
  bool may_cross() const { return ends != SplineEnds::periodic; }
  void crossings(const In& in, Crossings& value) const {
    value.first = cyclic ? around_whole(turns(in.master)) : not_below_zero(in.master - master.front());
    value.last = cyclic ? 1.0 : above_zero(in.master - master.back());
  }

 private:
  double period() const { return master.back() - master.front(); }
  double turns(double x) const { return (x - master.front()) / period(); }
  /// A triangular wave that changes sign where the greatest whole number below u changes, and nowhere else.
  static double around_whole(double u) {
    const double nearest = round_even(u), beyond = not_below_zero(u - nearest);
    return std::fmod(nearest, 2) == 0 ? beyond : -beyond;
  }
};
LOOPWRIGHT_BLOCK(CamTable)

}  // namespace loopwright::blocks
