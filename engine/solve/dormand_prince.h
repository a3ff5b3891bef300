/// The Dormand-Prince 5(4) method for the Solver.
#pragma once
#include <memory>

#include "engine/solve/stepper.h"

namespace loopwright {

std::unique_ptr<Stepper> make_dormand_prince(const SolverOptions& options, const OdeSystem& system);

}  // namespace loopwright
