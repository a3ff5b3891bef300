/// y = bias + amplitude · sin(2π · frequency · t + phase)
#include "blocks/sources/turns.h"

namespace loopwright::blocks {

template <class Real> struct Sine {
  Real amplitude = 1.0, frequency, phase = 0.0, bias = 0.0;
  struct Out {
    Real y;
  };
  static constexpr auto describe() {
    return block("A sine wave.",
                 parameter(&Sine::amplitude, "amplitude", "$y", "Half of the distance from trough to crest")
                     .difference()
                     .optional(),
                 parameter(&Sine::frequency, "frequency", "Hz", "Periods per second").not_negative(),
                 parameter(&Sine::phase, "phase", "rad", "Phase at time 0").optional(),
                 parameter(&Sine::bias, "bias", "$y", "Mean value").optional(),
                 output(&Out::y, "y", "$y", "The wave"));
  }
  void outputs(const Instant& now, Out& out) const {
    out.y = bias + amplitude * sine_of_turns(Real(frequency * now.time), phase);
  }
  double shortest_period() const {
    const double turns = lane(frequency, 0);
    return turns > 0.0 && lane(amplitude, 0) != 0.0 ? 1.0 / turns : infinity;
  }
};
LOOPWRIGHT_BLOCK(Sine)

}  // namespace loopwright::blocks
