/// Logic values as signals.
///
/// A logic value is a number without unit: 1 is true, 0 is false. Blocks write only these two. They read
/// everything above one half as true, as a `Switch` does, so that a recorded column may be interpolated. NaN
/// is neither, and stops the run. The first value of a signal is not an edge, whatever it is.
#pragma once
#include "blocks/math/sides.h"

namespace loopwright::blocks {

template <class Real> LW_INLINE MaskOf<Real> is_true(const Real& u) { return u > 0.5; }

template <class Real> LW_INLINE Real as_number(const MaskOf<Real>& truth) {
  return select(truth, Real(1.0), Real(0.0));
}

/// A crossing function: positive exactly where u is true.
template <class Real> LW_INLINE Real truth_crossing(const Real& u) { return above_zero(Real(u - 0.5)); }

template <class... Real> LW_INLINE Fault fault_unless_logic(const Real&... inputs) {
  return fault_if(((inputs != inputs) | ...), "a logic value is NaN, which is neither true nor false");
}

enum class EdgeKind { rising, falling, either };
constexpr auto names_of(EdgeKind) { return std::array<std::string_view, 3>{"rising", "falling", "either"}; }

/// The last logic value before the first one: neither true nor false.
inline constexpr double unknown_truth = 0.5;

/// Whether a change from `last` (0, 1 or unknown) to `now` is an edge of this kind.
template <class Real>
LW_INLINE MaskOf<Real> is_edge(EdgeKind kind, const Real& last, const MaskOf<Real>& now) {
  const auto rises = now & (last < unknown_truth), falls = (last > unknown_truth) & !now;
  if (kind == EdgeKind::rising) return rises;
  if (kind == EdgeKind::falling) return falls;
  return rises | falls;
}

}  // namespace loopwright::blocks
