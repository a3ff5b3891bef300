/// What may be said at the end, and what the records cannot support.
#pragma once
#include "tools/diagnose/conclude.h"
#include "tools/diagnose/diagnose.h"
#include "tools/diagnose/remaining_force.h"
#include "tools/effects/effect.h"

namespace loopwright::diagnosis {

/// What is wrong with the records, or missing in them, and what it costs.
std::vector<RecordFinding> look_at_records(const Trials& trials, const std::vector<InverseDynamics>& inverse);

/// Verdict, remainder and its variables, the latter along `motion`. `tight` is the noise of the search: with
/// the final one the slow force has taken over what is left.
void judge(Trials& trials, const Conclusion& conclusion, const Motion& motion, const Noise& tight,
           Diagnosis& diagnosis);

/// The experiment of the catalogue that tells the two apart.
SuggestedExperiment separating_experiment(const Effect& effect, const std::string& other);

/// Shares of the remaining slow force that functions of position, velocity, acceleration, input, time, and of
/// position or acceleration with the direction explain, on rows left out of their fit.
std::vector<RemainderShare> dependence_of(const Trials& trials, const std::vector<Fitted>& fitted);

}  // namespace loopwright::diagnosis
