/// The machine of an experiment: its measured motion, and its model driven only by the recorded input.
#pragma once
#include <memory>
#include <optional>
#include "engine/run/run.h"
#include "tools/compare/measured_motion.h"
#include "tools/experiment/experiment.h"

namespace loopwright {

/// The model with its input driven by the record, so that its states can be set to the measured values.
struct Machine {
  std::shared_ptr<const Plan> plan;
  std::shared_ptr<const Plan> undriven;  ///< the same with zero input
  MeasuredMotion motion;
  Number position = 0, velocity = 0;  ///< states of the plan
  Number sensor = 0;                  ///< stands for the measured position: the state, or a sensor's output
  Number net_force = -1;              ///< -1: no role "force"
  std::optional<Unit> force_unit;
  double mass = 0;  ///< [force s²/position] net force per acceleration of the model
};

/// A model that is compared with a record generates no noise: the record contains noise. Takes effect at the
/// next start.
void switch_off_noise(Run<double>& run, const Plan& plan);

/// The state of the model that a port shows: the port itself, or the state behind a sensor, found by
/// following the signal path backward to a state of the same unit. -1: none.
Number state_behind(const Plan& plan, Number number);

/// Whether a block between a state and its sensor is sampled, as an Encoder.
bool is_sampled_between(const Plan& plan, Number state, Number sensor);

/// Empty when the experiment is incomplete: `why` is then a sentence for the user.
std::optional<Machine> find_machine(const std::string& diagram, const Experiment& experiment,
                                    const LoadOptions& options, std::string& why);

/// Mean acceleration of the model over each sample, starting from the measured position and velocity. Sets
/// the machine's mass, and the driving force of its motion.
std::vector<double> model_acceleration(Machine& machine);

/// The signal is no longer computed: it keeps the value written into the arena.
void silence(Plan& plan, Number number);

/// The force produced by the input: the net force along a motion minus the net force without input, row by
/// row. Everything between them (gains, lags, saturations, position) is included; friction is not.
std::vector<double> driving_force(const std::vector<double>& with_input,
                                  const std::vector<double>& without_input);

/// The unit of the force as text. If the diagram leaves it open: the unit of the input if the input is the
/// force itself, else "1", because it is unknown.
std::string unit_of_force(const std::optional<Unit>& known, const MeasuredMotion& motion);

/// Position of the model, restarted from the measured motion after missing samples, and every `horizon`
/// samples; 0: only after missing samples.
std::vector<double> simulate_position(const Machine& machine, size_t horizon);

}  // namespace loopwright
