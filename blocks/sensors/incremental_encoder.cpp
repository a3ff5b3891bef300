/// y = q (n - n₀) + y₀,  n = round(x / q)
///
/// An incremental encoder knows only how far it has moved: at the start n₀ is the count there and y₀ is
/// `initial`, wherever the axis stands. A rising edge of `reset` (an index pulse, a homing switch) sets n₀ to
/// the present count and y₀ to `reset_value`. With resolution 0 it re-zeroes any measured position. `index`
/// is true while the axis stands on a reference mark, at `index_position` and every `index_pitch` from there.
#include "blocks/logic/truth.h"

namespace loopwright::blocks {

template <class Real> struct IncrementalEncoder {
  Real resolution, initial = 0.0, index_position = 0.0, index_pitch = 0.0, index_width = 0.0;
  Real per_count, half_width, per_pitch;
  struct In {
    Real position, reset, reset_value;
  };
  struct Out {
    Real position, index;
  };
  struct Mode {
    Real count, zero, value, last_reset, is_at_index;  // zero: a count, or a position without counts
  };
  struct Crossings {
    Real count, reset, index;
  };
  static constexpr auto describe() {
    using B = IncrementalEncoder;
    return block(
        "Measures a position in counts from where it was switched on or reset, with reference marks.",
        parameter(&B::resolution, "resolution", "$position", "Width of a count; 0: continuous")
            .difference()
            .not_negative(),
        parameter(&B::initial, "initial", "$position", "What it reads at the start").optional(),
        parameter(&B::index_position, "index_position", "$position", "True position of a reference mark")
            .optional(),
        parameter(&B::index_pitch, "index_pitch", "$position", "Distance between marks; 0: one mark")
            .difference()
            .not_negative()
            .optional(),
        parameter(&B::index_width, "index_width", "$position", "Width of a mark; 0: one count")
            .difference()
            .not_negative()
            .optional(),
        input(&In::position, "position", "$position", "True position"),
        input(&In::reset, "reset", "", "Logic value whose rising edge resets the count").otherwise(0.0),
        input(&In::reset_value, "reset_value", "$position", "What it reads after a reset").otherwise(0.0),
        output(&Out::position, "position", "$position", "Measured position"),
        output(&Out::index, "index", "", "1 on a reference mark, else 0").from(&In::position),
        crossing(&Crossings::count, "count"), crossing(&Crossings::reset, "reset"),
        crossing(&Crossings::index, "index"));
  }
  void check(const Checker& checker) const {
    if (index_pitch > 0 && std::max(resolution, index_width) >= index_pitch)
      checker.error("index_pitch", "the reference marks touch each other").expected =
          "an index_pitch above the width of a mark";
  }
  void prepare(double) {
    per_count = select(resolution > 0.0, 1.0 / resolution, Real(0.0));
    half_width = 0.5 * select(index_width > 0.0, index_width, resolution);
    per_pitch = select(index_pitch > 0.0, 1.0 / index_pitch, Real(0.0));
  }
  void start(Mode& mode) const { mode = {0.0, 0.0, initial, -1.0, 0.0}; }  // last_reset -1: not begun
  Fault decide(const In& in, Mode& mode) const {
    const auto resets = is_true(in.reset), begins = mode.last_reset < 0.0;
    mode.count = round_even(Real(in.position * per_count)) + 0.0;  // -0 becomes 0
    const auto is_set = is_edge<Real>(EdgeKind::rising, mode.last_reset, resets) & !begins;
    mode.value = select(is_set, in.reset_value, mode.value);
    mode.zero = select(is_set | begins, select(resolution > 0.0, mode.count, in.position), mode.zero);
    mode.last_reset = as_number<Real>(resets);
    mode.is_at_index = as_number<Real>(inside_mark(in.position) > 0.0);
    if (const Fault fault = fault_if_nan(in.position); fault.lanes) return fault;
    return fault_unless_logic(in.reset);
  }
  void outputs(const In& in, const Mode& mode, Out& out) const {
    const Real counted = resolution * (mode.count - mode.zero);
    out.position = mode.value + select(resolution > 0.0, counted, in.position - mode.zero);
    out.index = mode.is_at_index;
  }
  void crossings(const In& in, const Mode& mode, Crossings& value) const {
    const Real from_center = absolute(Real(in.position * per_count - mode.count));
    value.count = not_below_zero(Real(0.5 - from_center));
    value.reset = truth_crossing(in.reset);
    value.index = inside_mark(in.position);
  }

 private:
  /// Positive on a mark.
  Real inside_mark(const Real& position) const {
    const Real from_first = position - index_position;
    const Real from_mark = from_first - index_pitch * round_even(Real(from_first * per_pitch));
    return not_below_zero(Real(half_width - absolute(from_mark)));
  }
};
LOOPWRIGHT_BLOCK(IncrementalEncoder)

}  // namespace loopwright::blocks
