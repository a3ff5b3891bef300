/// The user's diagram, cut open at its input and with an additional force: the model that the predictor
/// steps.
///
/// Input and force may be different quantities, for example a current and the force that a motor produces
/// from it. The blocks between them are the diagram's own: gains, saturations, lags, sampled filters.
#pragma once
#include <Eigen/Dense>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include "engine/diagram/diagram.h"
#include "engine/plan/plan.h"
#include "tools/diagnose/predict/affine_sample.h"
#include "tools/diagnose/record/axis_record.h"
#include "tools/effects/switched_effect.h"

namespace loopwright {
template <class Real> class Run;
}

namespace loopwright::diagnosis {

struct AxisSteps;

/// x[k+1] = A x[k] + push F (a force held over the sample), y = C x; small deviations from the recorded
/// motion. Unobservable states are left out.
struct LinearAxis {
  Eigen::MatrixXd A;           ///< n×n
  Eigen::VectorXd push;        ///< n; effect of a unit of force that pushes forward
  Eigen::VectorXd input_push;  ///< n; effect of a unit of input
  Eigen::VectorXd noise_push;  ///< n; effect of white noise per unit of force
  /// n; effect of a force that grows by one unit within the sample with zero mean, as a fraction of the push.
  /// Without damping ∫ (T - τ)(τ/T - ½) dτ = -T²/12 is a sixth of ∫ (T - τ) dτ: the position changes by -1/6
  /// of the push, the velocity by nothing.
  Eigen::VectorXd slope_share;
  Eigen::MatrixXd C;                          ///< measured ports × n
  Eigen::Index position = -1, velocity = -1;  ///< among the states; -1: it is none
  Eigen::Index load_states = 0;  ///< the last ones, of loads that effects hang on the axis: see with_load()
  Eigen::VectorXd load_force;    ///< n; force that these loads consume; empty: none
  Eigen::VectorXd wander;        ///< n; noise of each state alone, standard deviation; empty: none
  double inertia = 0;            ///< force per acceleration, of the driven mass
  double damping = 0;            ///< force per speed
  /// Null: each row is the same. Otherwise A is that of a row on which the last load acts.
  std::shared_ptr<const AxisSteps> steps;
  const Eigen::MatrixXd& A_at(size_t row) const;
};

/// An axis with a load that touches and flies changes from row to row. Its states are the last ones.
struct AxisSteps {
  LinearAxis without;                         ///< this load
  std::vector<SwitchedSample::Follows> load;  ///< how its states begin with those of the axis
  std::vector<Eigen::MatrixXd> A;             ///< n×n
  std::vector<uint32_t> of_row;
};
inline const Eigen::MatrixXd& LinearAxis::A_at(size_t row) const {
  return steps ? steps->A[steps->of_row[row]] : A;
}

/// The blocks on which these numbers depend, without those of `beyond` and those that only lie behind them.
std::vector<bool> blocks_behind(const Plan& plan, const std::vector<Number>& wanted,
                                const std::vector<int>& beyond);

/// Only the blocks that the axis needs are computed; the controller, now disconnected, is not.
void keep_only(Plan& plan, const std::vector<Number>& wanted);

/// A solver step becomes a sample of the record, whose samples may have any length. Returns the ticks of a
/// sample time.
double step_by_samples(Plan& plan, const AxisRecord& record, int steps);

class AxisModel {
 public:
  /// The diagram at `path`, driven by the experiment's input alone, without noise that the machine does not
  /// feel. `rows_in_one`: see read_axis_record(). Throws InputError with every problem.
  AxisModel(const std::string& path, const std::string& experiment, const LoadOptions& options,
            const InputCorrection& correction = {}, size_t rows_in_one = 0);
  ~AxisModel();
  AxisModel(AxisModel&&) noexcept;

  const AxisRecord& record() const { return record_; }
  const Plan& plan() const { return *plan_; }
  bool has_position() const { return position_ >= 0; }
  /// Whether the diagram is linear but for constants, wherever the record leads it.
  bool is_affine() const { return is_affine_; }
  /// [force] The force produced by the recorded input, row by row: loopwright::driving_force().
  const std::vector<double>& driving_force() const { return driving_force_; }
  /// [force/input] The gain that fits the driving force best.
  double force_per_input() const { return force_per_input_; }
  const std::string& force_unit() const { return force_unit_; }
  const std::string& position_unit() const { return position_unit_; }

  /// Adds to the mass (or moment of inertia) on which the force acts; 0 is the user's own value. Returns
  /// false if the diagram has no such parameter.
  bool set_added_inertia(double added);
  /// Of the user's own diagram.
  double nominal_inertia() const { return nominal_inertia_; }
  /// Of a block, to which set_added_inertia() can add.
  bool has_mass() const { return !inertia_parameter_.empty(); }
  double nominal_damping() const { return nominal_damping_; }

  /// White noise acts as the input does, instead of on the role force; returns whether that differs.
  bool set_noise_enters_at_input(bool enters);

  /// Back to the start: velocity and, if given, position, with what hangs on the axis; everything else at the
  /// diagram's initial values.
  void start(std::optional<double> position, double velocity);
  /// Advances by a sample, or `duration` sample times, with held input and held force (added to the force
  /// role; pushes forward). A sample of an affine diagram is a sum of products, see AffineSample.
  void step(double input, double force, double duration = 1);
  double position() const;
  double velocity() const;
  double measured(size_t port) const;
  /// Steps of the method in a sample: several if a pole of the diagram is that fast.
  int steps_a_sample() const { return steps_a_sample_; }
  /// Observable states.
  std::span<const int> states() const { return seen_; }
  double state(int index) const;
  void correct(int index, double by);
  /// Whether the position is known as the integral of the measured velocity alone: a state that the velocity
  /// does not show, but on which forces may depend, as cogging does.
  bool position_follows_velocity() const;
  void shift_position(double by);
  /// The mean force on the moving part at the present state, including the added force.
  double net_force(double input, double force);
  /// The axis alone.
  void place(double position, double velocity);
  /// With what hangs on it.
  void move_to(double position, double velocity);
  /// The same force along a path, position by position: dry friction remembers the direction of approach.
  /// Lags and filters between input and force are in steady state.
  double net_force_at_rest(double position, double velocity, double input, double force);
  /// At the instant of a row the input changes: the net force after it, or the mean of before and after.
  enum class At { from_there_on, mean };
  /// The net force at every row along a motion. The input is held from its row to the next. Lags and filters
  /// between input and force follow it, and the force is the mean over the sample from there on, or over both
  /// samples about the row; in a map of balances each row is independent, and they are in steady state.
  std::vector<double> net_forces(std::span<const double> position, std::span<const double> velocity,
                                 std::span<const double> input, At at);
  /// Whether something in the diagram holds the axis at rest: a small force moves nothing, or the force at a
  /// place depends on the side from which the axis came.
  bool holds_at_rest(double small_force);

  /// Linearized around the recorded motion. For a map: the remaining sum of the forces, see balance_of.
  const LinearAxis& linearize();

 private:
  void look_between_input_and_force();
  void follow_fast_forces(const Plan& plan);
  std::vector<double> force_of_input();
  void relate_force_to_input(const std::optional<Unit>& force_unit);
  void let_inner_states_rest(double position, double velocity, double input);
  Eigen::VectorXd inner_states_after_sample(double position, double velocity, double input,
                                            const Eigen::VectorXd& from);
  double held_force(double input, double push);
  double mean_over_sample(double force_now, double input, double push);
  double net_force_along(double position, double velocity, double input, double force);
  void run_with(const Plan& plan, int steps);
  LinearAxis shorten_steps(const Plan& plan);
  LinearAxis linearize_motion();
  void keep_seen_states(const LinearAxis& linear);
  void step_run(double input, double force, double duration = 1);
  AffineSample affine_sample();
  bool is_affine_along_record();
  Eigen::VectorXd sample_from(const Eigen::VectorXd& states, double input, double force);

  std::shared_ptr<const Plan> plan_;
  double sample_ticks_ = 1;
  int steps_a_sample_ = 1;
  std::unique_ptr<Run<double>> run_;
  double* numbers_ = nullptr;  // the arena's
  Number input_ = -1, injected_ = -1, force_ = -1, position_ = -1, velocity_ = -1;
  bool all_outputs_ = false;  // a role is not a state: its block must run at every step
  std::string inertia_parameter_, force_unit_, position_unit_;
  bool noise_enters_at_input_ = false;
  double own_inertia_ = 0, nominal_inertia_ = 0, nominal_damping_ = 0;
  std::vector<int> seen_;
  std::vector<int> inner_states_;         // between input and force
  bool input_is_filtered_ = false;        // by states, sampled blocks or delays
  bool force_remembers_ = false;          // the net force now depends on more than motion and input
  Eigen::MatrixXd inner_decay_;           // of the inner states over a sample; empty: not yet computed
  std::vector<char> remembered_;          // the arena at an operating point
  std::optional<LinearAxis> linearized_;  // with the present inertia and noise
  bool is_affine_ = false;
  std::vector<int> affine_states_;
  std::optional<AffineSample> affine_;  // with the present inertia
  std::vector<double> driving_force_;
  double force_per_input_ = 0;
  AxisRecord record_;
};

}  // namespace loopwright::diagnosis
