/// A position that nobody measures.
#pragma once
#include "tools/diagnose/search/hypothesis.h"

namespace loopwright::diagnosis {

/// Whether a force is what the forces of the diagram change by where the position is somewhat beside the one
/// that is assumed: a wave at the pitch of the diagram's own, a quarter of it away, or a constant beside its
/// spring. Where only a velocity is measured, the position is its integral, and has wandered by s T √n after n
/// rows of T seconds, for the noise s of the readings. So little is no finding.
bool is_feigned_by_drift(const Trials& trials, const std::vector<Member>& members, const Noise& noise,
                         size_t member);

}  // namespace loopwright::diagnosis
