/// The force that a model leaves unexplained, by inverse dynamics, for display. Zero-phase filters make it
/// readable but biased on records with feedback; names and intervals come from the prediction errors instead.
#pragma once
#include "tools/compare/machine.h"
#include "tools/diagnose/search/maximum_likelihood.h"
#include "tools/diagnose/search/weight.h"

namespace loopwright::diagnosis {

/// Measured motion, filtered forward and backward, and the force that the nominal model lacks to explain it.
struct InverseDynamics {
  MeasuredMotion motion;
  Path path;  ///< the same, as the effects use it: its acceleration is a mean over samples
  std::vector<double> net_force;  ///< of the nominal diagram, as recorded
  std::vector<double> residual;   ///< net force minus inertia × acceleration
};

InverseDynamics inverse_dynamics(Trial& trial);

/// The nominal residual minus the force that the members consume, filtered below 80 Hz (or a tenth of the
/// sampling rate), or below a frequency that is so many times lower.
std::vector<double> residual_with(const Trial& trial, const InverseDynamics& inverse,
                                  const std::vector<Member>& members, double slower = 1);

/// The measured motion, in which only rows count that the filter of the residual does not mix with a reversal
/// or a rest: there the force of dry friction leaps, at an instant that the motion shows only roughly.
MeasuredMotion away_from_turns(const InverseDynamics& inverse);

/// Whether its motion is that of the axis: most of the rows that the trials use move in it. Of a motion that
/// is over within the period of the filter it shows a wobble or nothing, and no balance of forces.
bool balances_forces(const Trials& trials, const std::vector<InverseDynamics>& inverse);

struct ResidualSize {
  double fitted = 0, held_out = 0;  ///< root mean square; held_out 0 without held-out rows
};
ResidualSize residual_size(const Trials& trials, const std::vector<InverseDynamics>& inverse,
                           const std::vector<Member>& members);

/// The force that distinguishes two sets of members, as far as the residual shows it.
struct ForceShare {
  double found = 1;  ///< slope of the residual without it over the force: 1 if it is there, 0 if it is not
  double deviation = 0;  ///< standard deviation, from blocks of half a second
  double force = 0;      ///< root mean square of that force
};
/// Over the fitted rows; `without` is a subset of `with`.
ForceShare share_of_force(const Trials& trials, const std::vector<InverseDynamics>& inverse,
                          const std::vector<Member>& with, const std::vector<Member>& without,
                          double slower = 1);

/// Whether the force of a member occurs in the held-out rows: an end stop may be touched in others alone.
bool is_held_out(const Trials& trials, const std::vector<InverseDynamics>& inverse,
                 const std::vector<Member>& members, size_t member);

/// Whether a member makes the balance of the forces along the smooth motion worse. In a closed loop the input
/// answers to disturbances that the record of the motion does not yet show: a delay, a lag or a mode can
/// then predict a part of the noise, but does not fit the motion itself. Where noise drives the motion that
/// the force of an effect follows, as beside a resonance, the balance is as wrong: an effect that is loud in
/// the errors, and quieter than the noise in the balance, is not asked. Nor is a load that flies: the moments
/// of its blows are not those of the smooth motion. Nor is a loud effect at the input that is smaller than
/// what the noise of the sensor leaves in the balance: a controller answers to that noise. Nor is a load on a
/// spring that swings faster than the balance shows, unless it is not loud and a part of its force that does
/// show has the opposite sign. Nor does an input spoil it that the slow balance shows to be late.
bool spoils_balance(const Trials& trials, const Estimate& estimate, size_t member, const Weight& weight);

/// Whether a member is an input that the slow part of the motion surely shows to be late. What a controller
/// makes of the noise of a sensor is fast: there the balance, and a simulation by what it commanded, may
/// speak against what is true.
bool is_late_in_slow_balance(const Trials& trials, const std::vector<Member>& members, size_t member);

/// Whether it is one of which the slow part of the motion shows nothing, although it can tell. The search may
/// pass over such an answer to noise on its way to a load in a gap; it is no finding.
bool is_feigned_by_noise(const Trials& trials, const std::vector<Member>& members, size_t member);

/// Whether the force that the members leave is too small to matter, in the fitted rows and in the others.
bool is_negligible(const Trials& trials, const std::vector<Member>& members);

/// The residual that the noise alone would leave, from its spectrum, and the mass with that of the members.
double residual_floor(const Trials& trials, const Estimate& estimate);

/// What the noise of the sensor alone would leave: unlike that of the force it does not repeat with the
/// motion.
double residual_of_sensor(const Trials& trials, Estimate estimate);

}  // namespace loopwright::diagnosis
