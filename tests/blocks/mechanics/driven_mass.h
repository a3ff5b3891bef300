/// A mass under a given force and the friction of a block. The mode is decided at the start of each step and
/// held in it, as in a fixed-step run.
#pragma once
#include <functional>
#include "tests/blocks/block_under_test.h"

namespace loopwright {

struct DrivenMass {
  BlockUnderTest& friction;
  double mass;                                                                   // kg
  std::function<double(double time, double position, double velocity)> applied;  // N, without friction
  double time = 0, position = 0, velocity = 0;

  /// One step of classical Runge-Kutta; returns the friction at its start.
  double step(double h) {
    const double begin = time, x = position, v = velocity;
    const double at_start = force(begin, x, v, true);
    const double a1 = (applied(begin, x, v) - at_start) / mass;
    const double a2 = acceleration(begin + h / 2, x + h / 2 * v, v + h / 2 * a1);
    const double a3 = acceleration(begin + h / 2, x + h / 2 * (v + h / 2 * a1), v + h / 2 * a2);
    const double a4 = acceleration(begin + h, x + h * (v + h / 2 * a2), v + h * a3);
    position = x + h * v + h * h / 6 * (a1 + a2 + a3);
    velocity = v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    time = begin + h;
    return at_start;
  }

 private:
  double acceleration(double t, double x, double v) {
    return (applied(t, x, v) - force(t, x, v, false)) / mass;
  }
  double force(double t, double x, double v, bool decides) {
    friction.input("velocity") = v;
    for (const PortInfo& port : friction.info().inputs)
      if (port.name == "applied") friction.input("applied") = applied(t, x, v);
    if (decides)
      friction.evaluate(t);
    else
      friction.evaluate_held(t);
    return friction.output("force");
  }
};

/// The zero of a falling function between two times.
inline double root_between(double low, double high, const std::function<double(double)>& f) {
  for (int i = 0; i < 200; ++i) (f(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
  return low;
}

}  // namespace loopwright
