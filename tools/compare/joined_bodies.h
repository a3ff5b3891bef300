/// Bodies that are joined to the axis, as a load on a spring.
#pragma once
#include "engine/plan/plan.h"

namespace loopwright {

inline bool is_state(const Plan& plan, Number number) {
  return number >= plan.signals && number < plan.signals + plan.states;
}

/// Moves what hangs on the axis by as much as its position and its velocity will be moved, to these values,
/// so that nothing is strained by it: the bodies of a TwoMass, and those that couplings without a ratio join
/// to it. What is behind a gear or a screw stays. The two states themselves are not touched.
void carry_along(const Plan& plan, Number position, Number velocity, double to_position, double to_velocity,
                 double* states);

}  // namespace loopwright
