/// A law of motion that is multiplied by one number is the same law.
#pragma once
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/search/remaining_force.h"

namespace loopwright::diagnosis {

/// u = m a + b v + F is the same law as (1 + g) u = (1 + g) (m a + b v + F): what is named may be stated
/// otherwise.
/// - Input, mass and damping by one factor, beside forces F of the diagram: F is too strong by that factor.
/// - Mass and damping by one factor: the input is too strong or too weak, by its unit or its gain.
/// - The input alone: mass and damping are both wrong by one factor.
/// The last two only where the diagram has no forces of its own. Adds what each may be to the result.
void tell_common_factor(const Trials& trials, const std::vector<InverseDynamics>& inverse, Diagnosis& result);

}  // namespace loopwright::diagnosis
