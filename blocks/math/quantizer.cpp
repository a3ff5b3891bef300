/// y = q · round(u / q), halves to even
///
/// With a sample time it rounds at its samples. Without one it is continuous, and a variable-step solver
/// stops at every step of the staircase that affects a state. Give a sensor that is read by a sampled
/// controller the sample time of this controller.
#include "blocks/math/sides.h"

namespace loopwright::blocks {

template <class Real> struct Quantizer {
  Real resolution, per_resolution;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Mode {
    Real count;
  };
  struct Crossings {
    Real lower, upper;
  };
  static constexpr bool decides_anew = true;
  static constexpr auto describe() {
    return block(
        "Rounds a signal to multiples of a resolution.",
        parameter(&Quantizer::resolution, "resolution", "$u", "Height of a step").difference().positive(),
        input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$u", "The signal, rounded"),
        crossing(&Crossings::lower, "lower"), crossing(&Crossings::upper, "upper"));
  }
  void prepare(double) { per_resolution = 1.0 / resolution; }
  void decide(const In& in, Mode& mode) const { mode.count = round_even(Real(in.u * per_resolution)); }
  void outputs(const Mode& mode, Out& out) const { out.y = mode.count * resolution; }
  void crossings(const In& in, const Mode& mode, Crossings& value) const {
    value.lower = not_below_zero(Real(in.u * per_resolution - (mode.count - 0.5)));
    value.upper = above_zero(Real(in.u * per_resolution - (mode.count + 0.5)));
  }
};
LOOPWRIGHT_BLOCK(Quantizer)

}  // namespace loopwright::blocks
