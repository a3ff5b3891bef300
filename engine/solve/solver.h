/// Variable-step integration of an OdeSystem with stop times, events and dense output: dopri5, cvode-bdf,
/// cvode-adams.
///
/// How a run uses it:
///     Solver solver(options, system);
///     solver.start(t0, x0);
///     each stretch without a known discontinuity:
///       do result = solver.step(t_stop, wanted)         // record in between with solver.interpolate
///       while result.status == stepped
///       if result.status == event: handle solver.fired() at (solver.t(), solver.x())
///       if anything jumped: solver.restart(t, x)        // state, held signal, right-hand side
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/solve/event_finder.h"
#include "engine/solve/method.h"
#include "engine/solve/ode.h"

namespace loopwright {

class StateArchive;
class Stepper;

/// Below this the estimated error of a step is mainly rounding.
inline constexpr double smallest_relative_tolerance = 1e-13;

struct SolverOptions {
  Method method = Method::dopri5;
  double relative_tolerance = 1e-6;  ///< error of a step relative to |x|; smaller: more digits, more steps
  double absolute_tolerance = 1e-9;  ///< added to it, in the unit of the state: bounds small states
  std::vector<double> absolute_tolerances;  ///< one for each state, if sizes differ widely; empty: the above
  double initial_step = 0.0;                ///< [s] first trial; 0: from x, f and the change of f
  double maximum_step = std::numeric_limits<double>::infinity();  ///< [s] so that no short pulse is skipped
  int64_t maximum_steps_between_stops = 1'000'000;                ///< also rejected ones; ends a stuck run
  int crossing_samples = 4;  ///< samples of crossings per step; more find shorter double crossings

  /// The problems of these options for a system with so many states, one sentence each; empty: none.
  std::vector<std::string> problems(int states) const;
};

enum class SolverStatus : uint8_t {
  stepped,         ///< one step made, no event
  reached_stop,    ///< t() equals t_stop exactly
  event,           ///< crossings passed through zero, see fired()
  step_too_small,  ///< the error estimate requires a step below rounding
  no_convergence,  ///< the implicit equations of a step had no solution at any useful step size
  too_many_steps,  ///< maximum_steps_between_stops was exceeded
  non_finite,      ///< a derivative, crossing function or state is non-finite
  block_fault,     ///< a block refused the evaluation
  wrong_answer,    ///< the integrator reported success, but its time or state cannot be right
  bad_stop         ///< t_stop lies before t() or is not finite
};
/// "the step size fell below rounding"; continues "solver stopped at t = …: ".
std::string_view to_text(SolverStatus status);
/// Whether integration may continue after this status.
constexpr bool succeeded(SolverStatus status) { return status <= SolverStatus::event; }

/// Counts since start().
struct SolverStatistics {
  int64_t steps = 0;                   ///< accepted
  int64_t error_test_failures = 0;     ///< rejected because of their error
  int64_t convergence_failures = 0;    ///< rejected for unsolved equations, a fault or a non-finite value
  int64_t derivative_evaluations = 0;  ///< all, including those for Jacobians
  int64_t jacobian_evaluations = 0;
  int64_t crossing_evaluations = 0;
  int64_t restarts = 0;
  int64_t events = 0;
  int64_t stiff_steps = 0;  ///< dopri5: checked steps with h|λ| beyond its stability limit
  bool stiff = false;       ///< dopri5: so many consecutive that stability, not accuracy, limits the step
  int stiffest_state = -1;  ///< the state with the largest error at the first detection
  double smallest_step = std::numeric_limits<double>::infinity();  ///< [s] of steps not shortened by a stop
  int64_t trials() const { return steps + error_test_failures + convergence_failures; }
};

struct Advance {
  SolverStatus status;
  double t;  ///< [s] the time of the solution; after a failure, the end of the last successful step
};

/// Integrates one system. After construction the solver itself does not allocate, throw or format text. f and
/// the crossing functions are never evaluated outside the interval from start or restart to t_stop.
class Solver {
 public:
  /// Throws std::invalid_argument with every problem of the options or of the system.
  Solver(const SolverOptions& options, const OdeSystem& system);
  /// Uses the given method instead of options.method.
  Solver(std::unique_ptr<Stepper> method, const SolverOptions& options, const OdeSystem& system);
  Solver(Solver&&) noexcept;
  Solver& operator=(Solver&&) noexcept;
  ~Solver();

  /// Begins a new solution at t [s] with x[states]. Clears everything, including statistics, so that runs
  /// repeat bit by bit.
  void start(double t, const double* x);

  /// Continues at t [s] with x[states] after a discontinuity and discards the history of the solution.
  /// One-step methods keep their step size. Crossing values are evaluated again. A crossing that has just
  /// fired must leave zero before it fires again; one that is exactly zero keeps its last sign.
  void restart(double t, const double* x);

  /// One step, at most to t_stop or to the first event in it. `wanted[crossings]` are the directions that
  /// count; null: both, for all.
  Advance step(double t_stop, const Crossing* wanted = nullptr);

  /// Steps until t_stop, an event or a failure.
  Advance advance(double t_stop, const Crossing* wanted = nullptr);

  double t() const { return t_; }                                                   ///< [s]
  std::span<const double> x() const { return {x_, static_cast<size_t>(states_)}; }  ///< the state at t()

  /// The solution at any time between step_begin() and t(), with the accuracy of the method.
  double step_begin() const;
  void interpolate(double t, double* x) const;

  /// After an event, for each crossing: +1 it rose through zero, -1 it fell, 0 neither.
  std::span<const int8_t> fired() const { return events_.fired(); }

  /// How often each crossing had the other sign at only one of several samples in a step. If this happens,
  /// shorter double crossings may have been missed.
  std::span<const int64_t> narrow_passages() const { return events_.narrow_passages(); }

  /// Whether the solution can be archived here. CVODE does not expose its history: only possible after a
  /// restart.
  bool can_be_archived() const;
  /// Writes or reads everything on which the further solution depends. A solver with the same options and
  /// system then continues bit by bit.
  void archive(StateArchive& a);

  /// The state with the largest weighted error in the last trial step, so that a message can name its block;
  /// -1: none.
  int worst_state() const;

  const SolverStatistics& statistics() const;

 private:
  void stand_at_restart(double t);
  Advance stand_at_event();
  Advance stand_at(double t, double t_stop);
  SolverStatus take_step(double t_stop);

  std::unique_ptr<Stepper> stepper_;
  EventFinder events_;
  std::vector<double> x_between_;  ///< the state at t(), if that is not an end of the integrator's step
  const double* x_ = nullptr;
  double t_ = 0.0;
  int states_ = 0;
  bool signs_known_ = false;  ///< the signs of the crossings at t() have been evaluated
  int64_t maximum_trials_ = 0;
  int64_t trials_at_stop_ = 0;
};

}  // namespace loopwright
