/// The order and rate of outputs and decisions, and the algebraic loops among them.
#pragma once
#include "engine/plan/plan.h"

namespace loopwright {

/// Fills Plan::order, algebraic loops and rates. An algebraic loop is a problem unless
/// `solve_algebraic_loops`.
void find_order(Plan& plan, bool solve_algebraic_loops, Problems& problems);

}  // namespace loopwright
