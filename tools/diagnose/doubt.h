/// Rows of which the past of an effect cannot be told well enough.
#pragma once
#include "tools/diagnose/evidence.h"

namespace loopwright::diagnosis {

/// Whether a member's force may hang on what happened long before: a load that flies through a gap.
bool may_be_doubtful(const std::vector<Member>& members);

/// Rows of each record, as far as the trials are run along it, at which the members' force would be another
/// one, by more than noise, had the predictor seen the velocity with another of its own errors: when a load
/// that flew through a gap hits its flank, and until the predictor has corrected that. Errors of the velocity
/// are drawn from the predictor's own corrections: δ(k) = ρ δ(k-1) + c(k-L), c its correction of the
/// velocity at a sample, L one second or two.
std::vector<std::vector<char>> doubtful_rows(const Trials& trials, const Estimate& estimate);

/// Adds every shape that may be doubtful once more without its doubtful rows, as those of a member at its
/// start: a blow that is promised at the wrong moment would speak against the right gap.
void add_without_doubt(const Trials& trials, const Motion& motion, std::vector<Shape>& shapes);

/// Lets all rows count but those that are doubtful under this estimate, and works out its figures anew.
void leave_out_doubtful(Trials& trials, Estimate& estimate);

}  // namespace loopwright::diagnosis
