/// The ports of a diagram that an experiment names.
#pragma once
#include "engine/plan/plan.h"
#include "tools/compare/experiment.h"

namespace loopwright {

/// The plan with a log of what is compared and of the roles; a problem for every port that is not there, or
/// is of another dimension than its column.
Plan logging(const Plan& plan, const Experiment& experiment, Problems& problems);

/// The experiment with its compared columns in the units of their ports: hertz become radians per second, and
/// back. Units that do not fit are left; logging() tells of them.
Experiment in_units_of_ports(const Plan& plan, Experiment experiment);

/// Of a diagram and experiments that do not go together, or of which one cannot be used: adds all that is
/// wrong with them, and with the ports that the experiments name, to what was found already, and throws
/// InputError.
[[noreturn]] void explain_failure(const std::string& diagram, const std::vector<std::string>& experiments,
                                  const LoadOptions& options, Problems found);

}  // namespace loopwright
