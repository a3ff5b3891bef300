/// A fault as a sentence for the user.
#pragma once
#include <string>
#include "engine/plan/plan.h"

namespace loopwright {

/// "coulomb" stopped the run at t = 0.2 s: reason; for a fault of an algebraic loop, also its blocks.
std::string fault_text(const Plan& plan, const FaultReport& fault, double time);

}  // namespace loopwright
