/// What the page of a diagnosis draws, beside its tables.
#pragma once
#include "tools/diagnose/search/remaining_force.h"
#include "tools/diagnose/verdict/acceptance.h"
#include "tools/diagnose/verdict/improve.h"

namespace loopwright::diagnosis {

/// Adds curves, terms, whiteness and picture to the answer.
void add_plots(Trials& trials, const InverseDynamics& first_record, const Acceptance& accepted,
               const Improver& improver, const MachineUnits& units, const LoadOptions& load,
               Diagnosis& result);

/// The improved diagram; its added blocks have the room "added". Empty if it cannot be compiled.
report::Graph picture_of(const Improvement& improved, const LoadOptions& load);

}  // namespace loopwright::diagnosis
