/// In which order outputs and decisions are computed, how often, and where rings stand in the way.
#pragma once
#include "engine/plan/plan.h"

namespace loopwright {

/// Fills Plan::order, rings and rates. A ring of direct feedthrough is a problem unless `solve_rings`.
void find_order(Plan& plan, bool solve_rings, Problems& problems);

}  // namespace loopwright
