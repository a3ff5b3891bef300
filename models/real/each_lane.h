/// Functions that exist for one double only (double_functions.h), on any scalar of a simulation.
#pragma once
#include "models/real/real.h"

namespace loopwright {

/// f(x) or f(x, y) of every lane in turn: the same bits as for double.
template <Scalar Real, class F, class... Further>
LW_INLINE Real each_lane(F&& f, const Real& x, const Further&... further) {
  Real result = x;
  for (int l = 0; l < lanes_of<Real>; ++l) set_lane(result, l, f(lane(x, l), lane(further, l)...));
  return result;
}

}  // namespace loopwright
