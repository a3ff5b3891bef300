/// The machine of an experiment: its measured motion, and its model driven by the recorded input alone.
#pragma once
#include <memory>
#include <optional>
#include "engine/run/run.h"
#include "tools/compare/experiment.h"

namespace loopwright {

/// What was measured, on an even grid, cleaned of noise without shifting it in time.
struct MeasuredMotion {
  double start = 0, sample_time = 0;  ///< [s]
  std::vector<double> time;           ///< [s]
  std::vector<char> missing;          ///< samples without a row in the record; empty: none
  std::vector<double> raw_position;   ///< as recorded; integrated where only the velocity was measured
  std::vector<double> position, velocity, acceleration;  ///< below the cut-off; central differences
  std::vector<double> input;                             ///< held from each sample to the next
  /// What the input alone makes of force where the forces add up, by the model: see driving_force().
  std::vector<double> force;
  std::string position_unit, input_unit, force_unit;  ///< SI
  double cutoff = 0;                                  ///< [Hz] of position
  double rest_speed = 0;                              ///< [position/s] below it the machine counts as at rest
  std::vector<char> counts;  ///< rows away from rest, from missing samples and from the ends

  size_t rows() const { return time.size(); }
  bool is_missing(size_t row) const { return !missing.empty() && missing[row]; }
  double stroke() const;
  double top_speed() const;
};

/// Position, velocity and acceleration below the cut-off, and the rows that count: from the raw position, or
/// where there is none from the velocity as it was measured. Sample time and time must be there.
void smooth_motion(MeasuredMotion& motion);

/// The model with its input driven by the record, so that its states can be set to what was measured.
struct Machine {
  std::shared_ptr<const Plan> plan;
  std::shared_ptr<const Plan> undriven;  ///< the same with an input of nothing
  MeasuredMotion motion;
  Number position = 0, velocity = 0;  ///< states of the plan
  Number sensor = 0;      ///< what stands for the measured position: the state, or a sensor's output
  Number net_force = -1;  ///< -1: no role "force"
  std::optional<Unit> force_unit;
  double mass = 0;  ///< [force s²/position] net force per acceleration of the model
};

/// A model that is held against a record makes no noise of its own: the record has it. From the next start
/// on.
void switch_off_noise(Run<double>& run, const Plan& plan);

/// The state of the model that a port shows: itself, or the one behind a sensor, found against the signal
/// path among states of the same unit. -1: none.
Number state_behind(const Plan& plan, Number number);

/// Whether a block on the way from a state to its sensor works from sample to sample only, as an Encoder.
bool is_sampled_between(const Plan& plan, Number state, Number sensor);

/// Nothing when the experiment does not say enough: `why` is then a sentence for the user.
std::optional<Machine> find_machine(const std::string& diagram, const Experiment& experiment,
                                    const LoadOptions& options, std::string& why);

/// Mean acceleration of the model over each sample, begun from the measured position and velocity. Fills the
/// machine's mass, and the driving force of its motion.
std::vector<double> model_acceleration(Machine& machine);

/// Nobody computes the signal any more: it stays what is written into the arena.
void silence(Plan& plan, Number number);

/// What the input makes of force: the net force along a motion less what it would be without the input,
/// row by row. Whatever lies between them (gains, lags, saturations, position) is in it; friction is not.
std::vector<double> driving_force(const std::vector<double>& with_input,
                                  const std::vector<double>& without_input);

/// The unit of the force in words. Where the diagram leaves it open: that of the input if the input is the
/// force itself, else "1", as nobody knows.
std::string unit_of_force(const std::optional<Unit>& known, const MeasuredMotion& motion);

/// Position of the model, begun anew from the measured motion behind missing samples, and every `horizon`
/// samples; 0: not else.
std::vector<double> simulate_position(const Machine& machine, size_t horizon);

}  // namespace loopwright
