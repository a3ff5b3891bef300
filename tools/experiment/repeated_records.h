/// Records that are used together must be different ones.
#pragma once
#include "tools/experiment/experiment.h"

namespace loopwright {

/// Reports every experiment that has the measured rows of an earlier one. A record that counts twice makes
/// every interval narrower than it is, and held-out rows that are fitted prove nothing. Null ones are left
/// out.
void refuse_repeated_records(const std::vector<std::shared_ptr<const Experiment>>& experiments,
                             Problems& problems);

}  // namespace loopwright
