/// y = min(max(y₋, u - gap/2), u + gap/2): the play operator
#include "engine/block.h"

namespace loopwright::blocks {

/// A gear with play at slow motion: the output does not move until the input has crossed the gap. It is rate
/// independent and without inertia; BacklashCoupling is the physical model. The last output y₋ is updated at
/// samples, fixed steps and events, and is exact there if the input does not reverse in between. A
/// variable-step solver with neither samples nor events during a reversal would miss the reversal: give the
/// block a sample_time there, or use BacklashCoupling.
template <class Real> struct Backlash {
  Real gap, initial = 0.0;
  Real half;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Mode {
    Real y;
  };
  static constexpr auto describe() {
    return block("Lets the output follow the input with play.",
                 parameter(&Backlash::gap, "gap", "$u", "Width of the play").difference().not_negative(),
                 parameter(&Backlash::initial, "initial", "$u",
                           "Output before the start, moved only if the input is beyond the gap")
                     .optional(),
                 input(&In::u, "u", "$u", "Driving position"), output(&Out::y, "y", "$u", "Driven position"));
  }
  void prepare(double) { half = 0.5 * gap; }
  void start(Mode& mode) const { mode.y = initial; }
  Real play(const Real& last, const Real& u) const { return minimum(maximum(last, u - half), u + half); }
  void decide(const In& in, Mode& mode) const { mode.y = play(mode.y, in.u); }
  void outputs(const In& in, const Mode& mode, Out& out) const { out.y = play(mode.y, in.u); }
};
LOOPWRIGHT_BLOCK(Backlash)

}  // namespace loopwright::blocks
