/// The times of a diagram as ticks: base period, sample times, step, recording, start and stop.
#pragma once
#include "engine/plan/flatten.h"
#include "engine/plan/plan.h"

namespace loopwright {

/// Fills clock, start, stop, step and record ticks, method and tolerances of the plan, and period and offset
/// of its blocks. `flat_of_block[i]` is the index of the flat block of plan.blocks[i], or -1.
void find_times(const Diagram& diagram, const FlatDiagram& flat, const std::vector<int>& flat_of_block,
                Plan& plan, Problems& problems);

}  // namespace loopwright
