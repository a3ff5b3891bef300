/// α = (2 a - b - c)/3,  β = (b - c)/√3;  d = α cos θ + β sin θ,  q = β cos θ - α sin θ
///
/// Clarke's and Park's transformations in one, of amplitudes: three phases of amplitude U, with a at its
/// maximum at θ = 0, give d = U, q = 0. What the three phases have in common is left out.
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct ParkTransform {
  struct In {
    Real a, b, c, angle;
  };
  struct Out {
    Real d, q;
  };
  static constexpr auto describe() {
    return block("Turns three phases into the two coordinates of a rotor (Clarke and Park).",
                 input(&In::a, "a", "$u", "First phase"), input(&In::b, "b", "$u", "Second phase"),
                 input(&In::c, "c", "$u", "Third phase"),
                 input(&In::angle, "angle", "rad", "Angle of the field: pole pairs times that of the shaft"),
                 output(&Out::d, "d", "$u", "Along the magnets"),
                 output(&Out::q, "q", "$u", "Across the magnets"));
  }
  void outputs(const In& in, Out& out) const {
    constexpr double per_root_three = 0.57735026918962576;
    const Real alpha = (2.0 * in.a - in.b - in.c) * (1.0 / 3.0), beta = (in.b - in.c) * per_root_three;
    const Real cos = cosine(in.angle), sin = sine(in.angle);
    out.d = alpha * cos + beta * sin;
    out.q = beta * cos - alpha * sin;
  }
};
LOOPWRIGHT_BLOCK(ParkTransform)

}  // namespace loopwright::blocks
