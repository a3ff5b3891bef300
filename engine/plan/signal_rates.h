/// When signals change.
#pragma once
#include <vector>
#include "engine/plan/plan.h"

namespace loopwright {

/// Of every number of the plan, signals first; states are continuous.
std::vector<Rate> rates_of_signals(const Plan& plan);

}  // namespace loopwright
