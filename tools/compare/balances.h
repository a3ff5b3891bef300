/// Records of another kind: where an axis stood in balance, and what held it there.
#pragma once
#include "tools/compare/experiment.h"

namespace loopwright {

/// Joins the rows of each stand into one, their mean. A new stand begins where the role "position" has moved
/// by more than three of its resolution from where the stand began; without a resolution every row is one. A
/// stand with less than half the usual number of rows is dropped: there the axis only passed. Stands are
/// put a millisecond apart: the time that was recorded says nothing. A problem without at least fifty.
void gather_balances(Experiment& experiment, Problems& problems);

}  // namespace loopwright
