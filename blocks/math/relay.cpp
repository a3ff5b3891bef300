/// y switches to `on` when u rises above `switch_on`, back to `off` when it falls below `switch_off`
#include "blocks/math/sides.h"

namespace loopwright::blocks {

template <class Real> struct Relay {
  Real switch_on, switch_off, on = 1.0, off = 0.0;
  bool starts_on = false;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Mode {
    Real is_on;
  };
  struct Crossings {
    Real threshold;
  };
  static constexpr auto describe() {
    return block("A switch with hysteresis.",
                 parameter(&Relay::switch_on, "switch_on", "$u", "Above this it switches on"),
                 parameter(&Relay::switch_off, "switch_off", "$u", "Below this it switches off"),
                 parameter(&Relay::on, "on", "$y", "Output when on").optional(),
                 parameter(&Relay::off, "off", "$y", "Output when off").optional(),
                 parameter(&Relay::starts_on, "starts_on", "", "Whether it is on at the start").optional(),
                 input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$y", "The switched value"),
                 crossing(&Crossings::threshold, "threshold"));
  }
  void check(const Checker& checker) const {
    if (switch_off <= switch_on) return;
    checker.error("switch_off", "it would switch off above the level at which it switches on").expected =
        "switch_off <= switch_on";
  }
  void start(Mode& mode) const { mode.is_on = starts_on ? 1.0 : 0.0; }
  Fault decide(const In& in, Mode& mode) const {
    mode.is_on = select(in.u > switch_on, Real(1.0), select(in.u < switch_off, Real(0.0), mode.is_on));
    return fault_if_nan(in.u);
  }
  void outputs(const Mode& mode, Out& out) const { out.y = select(mode.is_on > 0.5, on, off); }
  void crossings(const In& in, const Mode& mode, Crossings& value) const {
    value.threshold = above_zero(select(mode.is_on > 0.5, switch_off - in.u, in.u - switch_on));
  }
};
LOOPWRIGHT_BLOCK(Relay)

}  // namespace loopwright::blocks
