/// The stability condition of the paper that the linear motor diagrams come from, Proposition 1: its
/// constants (52)-(62) computed from a diagram.
#pragma once
#include "tools/stability/loop.h"

namespace loopwright {

/// Nothing without observer and feedback. `linear` has the learned block taken out; `unit` is the α it has.
std::optional<PaperCondition> paper_condition(const LinearDiagram& linear, const LoopRoles& roles,
                                              const LearnedFunction& learned, double alpha, double unit,
                                              double sample_time);

}  // namespace loopwright
