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
  std::vector<double> raw_position;   ///< as recorded; integrated where only the velocity was measured
  std::vector<double> position, velocity, acceleration;  ///< below the cut-off; central differences
  std::vector<double> input;                             ///< held from each sample to the next
  std::string position_unit, force_unit;                 ///< SI
  double cutoff = 0;                                     ///< [Hz] of position
  double rest_speed = 0;     ///< [position/s] below it the machine counts as at rest
  std::vector<char> counts;  ///< rows away from rest and from the ends

  size_t rows() const { return time.size(); }
  double stroke() const;
  double top_speed() const;
};

/// Position, velocity and acceleration below the cut-off, and the rows that count: from the raw position, or
/// where there is none from the velocity as it was measured. Sample time and time must be there.
void smooth_motion(MeasuredMotion& motion);

/// The model with its input driven by the record, so that its states can be set to what was measured.
struct Machine {
  std::shared_ptr<const Plan> plan;
  MeasuredMotion motion;
  Number position = 0, velocity = 0;  ///< states of the plan
  Number sensor = 0;      ///< what stands for the measured position: the state, or a sensor's output
  Number net_force = -1;  ///< -1: no role "force"
  double mass = 0;        ///< [force s²/position] net force per acceleration of the model
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

/// Mean acceleration of the model over each sample, begun from the measured position and velocity.
std::vector<double> model_acceleration(Machine& machine);

/// Position of the model, begun anew from the measured motion every `horizon` samples; 0: only at the start.
std::vector<double> simulate_position(const Machine& machine, size_t horizon);

}  // namespace loopwright
