/// The stability condition of the paper from which the linear motor diagrams are taken, Proposition 1: its
/// constants (52)-(62) computed from a diagram.
#pragma once
#include "tools/stability/loop.h"

namespace loopwright {

/// Empty without observer and feedback. In `linear` the learned block is removed; `unit` is its α.
std::optional<PaperCondition> paper_condition(const LinearDiagram& linear, const LoopRoles& roles,
                                              const LearnedFunction& learned, double alpha, double unit,
                                              double sample_time);

}  // namespace loopwright
