/// The final statements, and what the records do not support.
#pragma once
#include "tools/diagnose/search/conclude.h"
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/search/remaining_force.h"
#include "tools/diagnose/verdict/free_run.h"
#include "tools/effects/effect.h"

namespace loopwright::diagnosis {

/// Faults of the records and missing excitation, with their consequences.
std::vector<RecordFinding> look_at_records(const Trials& trials, const std::vector<InverseDynamics>& inverse);
/// Fatal: fewer fitted rows than a verdict needs.
std::optional<RecordFinding> too_few_rows(const Trials& trials);
/// Where all motion goes one way, a law of the position that was found may be friction that changes along the
/// way.
std::optional<RecordFinding> friction_along_the_way(const Trials& trials, const Estimate& estimate);

/// Readings that are not those of their rows, and what was done about them: see loopwright::false_readings.
RecordFinding readings_are_false(size_t count, std::string consequence);

/// Fatal: the readings of an angle begin anew at each turn.
RecordFinding angle_leaps(std::string_view angle, size_t count);

/// The search used up its operations.
RecordFinding ended_at_limit(double most_work);
/// The noise of the force is loud, as long as nothing is found in it: what would look like it.
RecordFinding noise_is_loud(double share_of_drive, double shortest_pitch, const MachineUnits& units);
/// The rows that are simulated hold too few stretches of a horizon.
RecordFinding too_few_simulations(const FreeRun& run);
/// Values of recorded inputs that were taken away because the machine does not feel them.
RecordFinding inputs_are_not_felt(size_t count);
RecordFinding input_is_logged_late(size_t rows);
/// Noise was taken away from the recorded input: see noise_instead_of_late_input().
RecordFinding input_is_noisy(const Trials& trials, const InputCorrection& noise);

/// Verdict, remainder and its variables, the latter along `motion`. `tight` is the noise of the search: with
/// the final noise, the slow force has absorbed the remainder. Nothing is explained as long as the residual
/// force of `inverse` dynamics exceeds the noise that repeats of the motion show, or as the diagram with the
/// effects simulates worse.
void judge(Trials& trials, const Conclusion& conclusion, const Motion& motion, const Noise& tight,
           const std::vector<InverseDynamics>& inverse, Diagnosis& diagnosis);

/// The experiment of the catalogue that distinguishes the two.
SuggestedExperiment separating_experiment(const Effect& effect, const std::string& other);

/// Shares of the remaining slow force that are explained by functions of position, velocity, acceleration,
/// input, time, and of position or acceleration with the direction, on rows left out of their fit.
std::vector<RemainderShare> dependence_of(const Trials& trials, const std::vector<Fitted>& fitted);

}  // namespace loopwright::diagnosis
