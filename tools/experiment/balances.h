/// Another kind of record: the positions at which an axis stood in balance, and the force that held it there.
#pragma once
#include "tools/experiment/experiment.h"

namespace loopwright {

/// Reports a problem if the experiment is a map of balances, which no simulation in time can follow.
void reject_map(const Experiment& experiment, Problems& problems);

/// Joins the rows of each stand into one, their mean. A new stand begins when the role "position" has moved
/// by more than three of its resolutions from where the stand began; without a resolution every row is a
/// stand. A stand with less than half the usual number of rows is dropped, because the axis only passed
/// through. Stands are placed a millisecond apart, because the recorded time has no meaning. Fewer than fifty
/// stands are a problem.
void gather_balances(Experiment& experiment, Problems& problems);

}  // namespace loopwright
