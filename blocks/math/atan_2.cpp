/// angle = the angle of the point (x, y), in rad from -π to π; 0 at the origin
///
/// It jumps by 2π where the point passes the negative x axis: an event for a variable-step solver.
#include "blocks/math/sides.h"

namespace loopwright::blocks {

template <class Real> struct Atan2 {
  struct In {
    Real y, x;
  };
  struct Out {
    Real angle;
  };
  struct Crossings {
    Real y;
  };
  static constexpr auto describe() {
    return block("The angle of a point in the plane.", input(&In::y, "y", "$length", "Height of the point"),
                 input(&In::x, "x", "$length", "Width of the point"),
                 output(&Out::angle, "angle", "rad", "Angle from the x axis"), crossing(&Crossings::y, "y"));
  }
  void outputs(const In& in, Out& out) const { out.angle = arc_tangent2(in.y, in.x); }
  void crossings(const In& in, Crossings& value) const { value.y = not_below_zero(in.y); }
};
LOOPWRIGHT_BLOCK(Atan2)

}  // namespace loopwright::blocks
