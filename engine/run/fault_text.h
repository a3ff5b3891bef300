/// A fault as a sentence for a person.
#pragma once
#include <string>
#include "engine/plan/plan.h"

namespace loopwright {

/// "coulomb" stopped the run at t = 0.2 s: reason; and the blocks of the algebraic loop, if that is it.
std::string fault_text(const Plan& plan, const FaultReport& fault, double time);

}  // namespace loopwright
