/// α = d cos θ - q sin θ,  β = d sin θ + q cos θ;  a = α,  b = (√3 β - α)/2,  c = -(√3 β + α)/2
///
/// The inverse of ParkTransform for phases that add up to zero.
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct InverseParkTransform {
  struct In {
    Real d, q, angle;
  };
  struct Out {
    Real a, b, c;
  };
  static constexpr auto describe() {
    return block("Turns the two coordinates of a rotor into three phases.",
                 input(&In::d, "d", "$u", "Along the magnets"),
                 input(&In::q, "q", "$u", "Across the magnets"),
                 input(&In::angle, "angle", "rad", "Angle of the field: pole pairs times that of the shaft"),
                 output(&Out::a, "a", "$u", "First phase"), output(&Out::b, "b", "$u", "Second phase"),
                 output(&Out::c, "c", "$u", "Third phase"));
  }
  void outputs(const In& in, Out& out) const {
    constexpr double half_root_three = 0.86602540378443865;
    const Real cos = cosine(in.angle), sin = sine(in.angle);
    const Real alpha = in.d * cos - in.q * sin, beta = half_root_three * (in.d * sin + in.q * cos);
    out.a = alpha;
    out.b = beta - 0.5 * alpha;
    out.c = -beta - 0.5 * alpha;
  }
};
LOOPWRIGHT_BLOCK(InverseParkTransform)

}  // namespace loopwright::blocks
