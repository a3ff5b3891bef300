/// count grows by 1 at every rising edge of `up`, and falls by 1 at every rising edge of `down`
///
/// Without a sample time, edges are counted at their exact instants; with one, from sample to sample. An
/// input that is true at the start has no edge there.
#include "blocks/logic/truth.h"

namespace loopwright::blocks {

template <class Real> struct Counter {
  Real initial = 0.0, low = -infinity, high = infinity;
  bool wraps = false;
  struct In {
    Real up, down, reset;
  };
  struct Out {
    Real count;
  };
  struct Mode {
    Real count, last_up, last_down;
  };
  struct Crossings {
    Real up, down, reset;
  };
  static constexpr auto describe() {
    return block(
        "Counts rising edges, up and down.",
        parameter(&Counter::initial, "initial", "", "Count at the start and after a reset").optional(),
        parameter(&Counter::low, "low", "", "Least count").optional(),
        parameter(&Counter::high, "high", "", "Greatest count").optional(),
        parameter(&Counter::wraps, "wraps", "", "Whether the count passes from one limit to the other")
            .optional(),
        input(&In::up, "up", "", "Logic value whose rising edges count up"),
        input(&In::down, "down", "", "Logic value whose rising edges count down").otherwise(0.0),
        input(&In::reset, "reset", "", "Logic value: while it is true, nothing is counted").otherwise(0.0),
        output(&Out::count, "count", "", "The count"), crossing(&Crossings::up, "up"),
        crossing(&Crossings::down, "down"), crossing(&Crossings::reset, "reset"));
  }
  void check(const Checker& checker) const {
    if (!(low <= initial && initial <= high))
      checker.error("initial", "the limits do not hold the initial count").expected =
          "low <= initial <= high";
    for (const auto& [name, limit] : {std::pair("initial", initial), {"low", low}, {"high", high}})
      if (std::isfinite(limit) && limit != std::floor(limit))
        checker.error(name, "a count is a whole number").found = reading::number_text(limit);
    if (wraps && !(std::isfinite(low) && std::isfinite(high)))
      checker.error("wraps", "a count that wraps needs both limits").expected = "\"low\" and \"high\"";
  }
  void start(Mode& mode) const { mode = {initial, unknown_truth, unknown_truth}; }
  Fault decide(const In& in, Mode& mode) const {
    const auto up = is_true(in.up), down = is_true(in.down);
    const Real count = mode.count + as_number<Real>(is_edge<Real>(EdgeKind::rising, mode.last_up, up)) -
                       as_number<Real>(is_edge<Real>(EdgeKind::rising, mode.last_down, down));
    const Real limited = wraps ? select(count > high, low, select(count < low, high, count))
                               : minimum(maximum(count, low), high);
    mode.count = select(is_true(in.reset), initial, limited);
    mode.last_up = as_number<Real>(up), mode.last_down = as_number<Real>(down);
    return fault_unless_logic(in.up, in.down, in.reset);
  }
  void outputs(const Mode& mode, Out& out) const { out.count = mode.count; }
  void crossings(const In& in, Crossings& value) const {
    value.up = truth_crossing(in.up);
    value.down = truth_crossing(in.down);
    value.reset = truth_crossing(in.reset);
  }
};
LOOPWRIGHT_BLOCK(Counter)

}  // namespace loopwright::blocks
