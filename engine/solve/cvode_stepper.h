/// CVODE's variable-order formulas, BDF and Adams, for the Solver.
#pragma once
#include <memory>

#include "engine/solve/stepper.h"

namespace loopwright {

std::unique_ptr<Stepper> make_cvode_stepper(const SolverOptions& options, const OdeSystem& system);

}  // namespace loopwright
