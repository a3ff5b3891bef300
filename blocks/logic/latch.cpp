/// y becomes 1 while `set` is true, 0 while `reset` is true, and stays as it is while neither is
#include "blocks/logic/truth.h"

namespace loopwright::blocks {

enum class LatchPriority { reset, set };
constexpr auto names_of(LatchPriority) { return std::array<std::string_view, 2>{"reset", "set"}; }

template <class Real> struct Latch {
  LatchPriority priority = LatchPriority::reset;
  bool starts_on = false;
  struct In {
    Real set, reset;
  };
  struct Out {
    Real y;
  };
  struct Mode {
    Real is_set;
  };
  struct Crossings {
    Real set, reset;
  };
  static constexpr auto describe() {
    return block(
        "Stores a logic value until it is reset.",
        parameter(&Latch::priority, "priority", "", "Which input wins while both are true").optional(),
        parameter(&Latch::starts_on, "starts_on", "", "Whether it is set at the start").optional(),
        input(&In::set, "set", "", "Logic value that sets it"),
        input(&In::reset, "reset", "", "Logic value that resets it").otherwise(0.0),
        output(&Out::y, "y", "", "1 while it is set, else 0"), crossing(&Crossings::set, "set"),
        crossing(&Crossings::reset, "reset"));
  }
  void start(Mode& mode) const { mode.is_set = starts_on ? 1.0 : 0.0; }
  Fault decide(const In& in, Mode& mode) const {
    const auto sets = is_true(in.set), resets = is_true(in.reset);
    mode.is_set = priority == LatchPriority::reset
                      ? select(resets, Real(0.0), select(sets, Real(1.0), mode.is_set))
                      : select(sets, Real(1.0), select(resets, Real(0.0), mode.is_set));
    return fault_unless_logic(in.set, in.reset);
  }
  void outputs(const Mode& mode, Out& out) const { out.y = mode.is_set; }
  void crossings(const In& in, Crossings& value) const {
    value.set = truth_crossing(in.set);
    value.reset = truth_crossing(in.reset);
  }
};
LOOPWRIGHT_BLOCK(Latch)

}  // namespace loopwright::blocks
