/// F = u (1 - s |u|) up to |u| = 1/(2s); ±1/(4s) beyond
#include "engine/block.h"

namespace loopwright::blocks {

/// Saturation of the iron of a motor: the deviation of the force from its command grows with the square of
/// the command, until the force is constant. The curve is smooth, and linear in s below its end. Saturation
/// is the hard limit of an amplifier.
template <class Real> struct ForceSaturation {
  Real droop;
  Real end;
  struct In {
    Real command;
  };
  struct Out {
    Real force;
  };
  static constexpr auto describe() {
    return block("A motor whose force falls behind a large command.",
                 parameter(&ForceSaturation::droop, "droop", "1/$force",
                           "s: fraction of the force that is lost, per command")
                     .not_negative(),
                 input(&In::command, "command", "$force", "Force that is asked for"),
                 output(&Out::force, "force", "$force", "Force that the motor gives"));
  }
  void prepare(double) { end = select(droop > 0.0, 0.5 / droop, Real(infinity)); }
  void outputs(const In& in, Out& out) const {
    const Real u = minimum(maximum(in.command, -end), end);
    out.force = u * (1.0 - droop * absolute(u));
  }
};
LOOPWRIGHT_BLOCK(ForceSaturation)

}  // namespace loopwright::blocks
