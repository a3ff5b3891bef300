/// A delay and a lag, each in the place of the other.
#pragma once
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {

/// Members that are pure shapes (a delay, a lag) replaced by another pure shape of the same size: they are
/// equal to first order, and too nonlinear for the linearization to distinguish.
std::vector<Proposal> shape_swaps(const std::vector<Member>& members,
                                  const std::vector<Candidate>& candidates);

}  // namespace loopwright::diagnosis
