/// The diagram ports that an experiment names.
#pragma once
#include <string_view>
#include "engine/plan/plan.h"
#include "tools/experiment/experiment.h"

namespace loopwright {

/// The plan with a log of the compared signals and the roles. Reports a problem for every port that does not
/// exist or has another dimension than its column, and the warning of check_unit_of_time().
Plan logging(const Plan& plan, const Experiment& experiment, Problems& problems);

/// A warning at this place of the experiment if rows and samples are a thousand times apart, or rows many steps
/// of the solver of a diagram without samples: such a time is rather in ms than in s, but it may be a slow log.
/// Whether rows are a thousand samples apart, to a hundredth of that, and no sample time is near them, or so
/// many steps and more than half a second: nobody logs an axis so.
constexpr std::string_view time_of_rows = "/data";
bool check_unit_of_time(const Plan& plan, const Experiment& experiment, Problems& problems);

/// The experiment with its compared columns in the units of their ports: hertz become radians per second, and
/// vice versa. Incompatible units are left unchanged; logging() reports them.
Experiment in_units_of_ports(const Plan& plan, Experiment experiment);

/// For a diagram and experiments that do not fit together, or cannot be used: adds all their problems, and
/// those of the ports that the experiments name, to the problems already found, and throws InputError.
[[noreturn]] void explain_failure(const std::string& diagram, const std::vector<std::string>& experiments,
                                  const LoadOptions& options, Problems found);

}  // namespace loopwright
