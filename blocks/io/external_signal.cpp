/// y = value + (t - since) (slope + (t - since) bend)
#include "engine/block.h"

namespace loopwright::blocks {

/// The input for a program that steps a run itself. The program sets the parameters between steps, and the
/// signal follows immediately. Slope and bend let a signal that is known at samples change within them. In a
/// run from a file the signal is the parabola given by the parameters.
template <class Real> struct ExternalSignal {
  Real value = 0.0, slope = 0.0, bend = 0.0, since = 0.0;
  struct Out {
    Real y;
  };
  static constexpr auto describe() {
    return block(
        "A signal that the surrounding program sets while the diagram runs.",
        parameter(&ExternalSignal::value, "value", "$y", "Value at the time `since`").optional(),
        parameter(&ExternalSignal::slope, "slope", "$y/s", "Its change per time then").optional(),
        parameter(&ExternalSignal::bend, "bend", "$y/s^2", "Half of its second derivative").optional(),
        parameter(&ExternalSignal::since, "since", "s", "Time to which value and slope belong").optional(),
        output(&Out::y, "y", "$y", "The signal"));
  }
  void outputs(const Instant& now, Out& out) const {
    const Real passed = now.time - since;
    out.y = value + passed * (slope + passed * bend);
  }
};
LOOPWRIGHT_BLOCK(ExternalSignal)

}  // namespace loopwright::blocks
