/// Rows at which the past of an effect is not known accurately enough.
#pragma once
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {

/// Whether a member's force may depend on events long before: a load that moves freely through a gap.
bool may_be_doubtful(const std::vector<Member>& members);

/// Rows of each record, on the range covered by the trials, at which the members' force would differ by more
/// than noise if the predictor's velocity had a different error. This is the case when a load that moved
/// through a gap hits its flank, and until the predictor has corrected it. Errors of the velocity are drawn
/// from the predictor's own corrections: δ(k) = ρ δ(k-1) + c(k-L), c its correction of the velocity at a
/// sample, L one second or two.
std::vector<std::vector<char>> doubtful_rows(const Trials& trials, const Estimate& estimate);

/// Adds shapes that may be doubtful a second time without their doubtful rows, computed for a member at
/// its initial values: an impact predicted at the wrong moment would be evidence against the right gap.
void add_without_doubt(const Trials& trials, const Motion& motion, std::vector<Shape>& shapes);

/// Lets all rows count except those that are doubtful under this estimate, and recomputes its figures.
void leave_out_doubtful(Trials& trials, Estimate& estimate);

}  // namespace loopwright::diagnosis
