/// The numbers of a plan that may differ between the runs that share it, and the remainder of the plan.
#pragma once
#include <map>
#include "engine/plan/plan.h"

namespace loopwright {

/// Every tunable number by its path, "stage.cogging.harmonics.0.amplitude".
std::map<std::string, double> tunable_numbers(const Plan& plan);

/// Everything else: two plans with the same skeleton differ only in tunable numbers.
std::string skeleton(const Plan& plan);

}  // namespace loopwright
