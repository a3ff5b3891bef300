/// Laws of the velocity whose sums look alike.
#pragma once
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {

/// Several laws of the velocity are known by their sum alone. Another law in place of one of them may state
/// the same sum with the amplitudes of all the others changed, by more than a linearization of the errors can
/// foresee: a drag of eddy currents is friction that is smooth around rest, with less damping. For every such
/// law among the members, beside another one, and for every law that is no member: amplitudes and shape of
/// the sum that comes nearest to the present one over the velocities of the records. The nearest first; none
/// that is further away than the noise of the force in one sample, or has an amplitude outside its range.
std::vector<Proposal> velocity_law_swaps(const Trials& trials, const Estimate& estimate,
                                         const std::vector<Shape>& shapes);

}  // namespace loopwright::diagnosis
