/// y = u at the last edge of `trigger`; with "while_true", y = u while `trigger` is true, then held
///
/// Without a sample time, edges are found at their exact instants. The first value of `trigger` is not an
/// edge. To sample periodically, use ZeroOrderHold.
#include "blocks/logic/truth.h"

namespace loopwright::blocks {

enum class HoldKind { rising, falling, either, while_true };
constexpr auto names_of(HoldKind) {
  return std::array<std::string_view, 4>{"rising", "falling", "either", "while_true"};
}

template <class Real> struct SampleAndHold {
  HoldKind samples = HoldKind::rising;
  Real initial = 0.0;
  struct In {
    Real u, trigger;
  };
  struct Out {
    Real y;
  };
  struct Mode {
    Real held, last;
  };
  struct Crossings {
    Real trigger;
  };
  static constexpr auto describe() {
    using B = SampleAndHold;
    return block(
        "Holds the value that a signal had when a logic value changed.",
        parameter(&B::samples, "samples", "", "At which edge, or while the trigger is true").optional(),
        parameter(&B::initial, "initial", "$u", "Output before the first edge").optional(),
        input(&In::u, "u", "$u", "Signal"), input(&In::trigger, "trigger", "", "Logic value, true above 0.5"),
        output(&Out::y, "y", "$u", "The value that is held"), crossing(&Crossings::trigger, "trigger"));
  }
  void start(Mode& mode) const { mode = {initial, unknown_truth}; }
  Fault decide(const In& in, Mode& mode) const {
    const auto on = is_true(in.trigger);
    const EdgeKind kind = samples == HoldKind::while_true ? EdgeKind::falling : EdgeKind(samples);
    mode.held = select(is_edge<Real>(kind, mode.last, on), in.u, mode.held);
    mode.last = as_number<Real>(on);
    return fault_unless_logic(in.trigger);
  }
  void outputs(const In& in, const Mode& mode, Out& out) const {
    out.y = samples == HoldKind::while_true ? select(mode.last > 0.5, in.u, mode.held) : mode.held;
  }
  void crossings(const In& in, Crossings& value) const { value.trigger = truth_crossing(in.trigger); }
};
LOOPWRIGHT_BLOCK(SampleAndHold)

}  // namespace loopwright::blocks
