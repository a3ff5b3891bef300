/// u = M a + B v + F sign(v)
///
/// F is the Coulomb friction. Its term is zero at rest and jumps when the sign of v changes.
#include "blocks/math/sides.h"

namespace loopwright::blocks {

template <class Real> struct MotionFeedforward {
  Real mass, damping, coulomb = 0.0;
  struct In {
    Real velocity, acceleration;
  };
  struct Out {
    Real command;
  };
  struct Mode {
    Real direction;
  };
  struct Crossings {
    Real forwards, backwards;
  };
  static constexpr bool decides_anew = true;
  static constexpr auto describe() {
    using B = MotionFeedforward;
    return block("The command that a nominal mass with friction needs for a motion.",
                 parameter(&B::mass, "mass", "$command*s/$velocity", "Nominal mass"),
                 parameter(&B::damping, "damping", "$command/$velocity", "Nominal viscous friction"),
                 parameter(&B::coulomb, "coulomb", "$command", "Nominal Coulomb friction").optional(),
                 input(&In::velocity, "velocity", "$velocity", "Wanted velocity"),
                 input(&In::acceleration, "acceleration", "$velocity/s", "Wanted acceleration"),
                 output(&Out::command, "command", "$command", "Command"),
                 crossing(&Crossings::forwards, "forwards"), crossing(&Crossings::backwards, "backwards"));
  }
  void decide(const In& in, Mode& mode) const { mode.direction = sign_of(in.velocity); }
  void outputs(const In& in, const Mode& mode, Out& out) const {
    out.command = mass * in.acceleration + damping * in.velocity + coulomb * mode.direction;
  }
  bool may_cross() const { return any(coulomb != 0.0); }
  void crossings(const In& in, Crossings& value) const {
    value.forwards = above_zero(in.velocity);
    value.backwards = not_below_zero(in.velocity);
  }
};
LOOPWRIGHT_BLOCK(MotionFeedforward)

}  // namespace loopwright::blocks
