#include "engine/solve/solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/solve/cvode_stepper.h"
#include "engine/solve/dormand_prince.h"
#include "engine/solve/stepper.h"

namespace loopwright {

std::vector<std::string> SolverOptions::problems(int states) const {
  std::vector<std::string> found;
  const auto require = [&](bool good, std::string sentence) {
    if (!good) found.push_back(std::move(sentence));
  };
  require(!is_fixed_step(method),
          fmt::format("{} has a fixed step, the variable-step solver does not run it", to_name(method)));
  require(relative_tolerance >= smallest_relative_tolerance && relative_tolerance < 1.0,
          fmt::format("relative_tolerance must lie in [{}, 1), it is {}", smallest_relative_tolerance,
                      relative_tolerance));
  require(absolute_tolerance > 0.0 && std::isfinite(absolute_tolerance),
          fmt::format("absolute_tolerance must be positive, it is {}", absolute_tolerance));
  require(
      absolute_tolerances.empty() || std::ssize(absolute_tolerances) == states,
      fmt::format("absolute_tolerances has {} entries for {} states", absolute_tolerances.size(), states));
  for (size_t i = 0; i < absolute_tolerances.size(); ++i) {
    require(absolute_tolerances[i] > 0.0 && std::isfinite(absolute_tolerances[i]),
            fmt::format("absolute_tolerances[{}] must be positive, it is {}", i, absolute_tolerances[i]));
  }
  require(initial_step >= 0.0 && std::isfinite(initial_step),
          fmt::format("initial_step must be 0 or a time in s, it is {}", initial_step));
  require(maximum_step > 0.0, fmt::format("maximum_step must be positive, it is {}", maximum_step));
  require(maximum_steps_between_stops > 0,
          fmt::format("maximum_steps_between_stops must be positive, it is {}", maximum_steps_between_stops));
  require(crossing_samples > 0, fmt::format("crossing_samples must be positive, it is {}", crossing_samples));
  return found;
}

std::string_view to_text(SolverStatus status) {
  switch (status) {
    case SolverStatus::stepped:
      return "one step was taken";
    case SolverStatus::reached_stop:
      return "the stop time was reached";
    case SolverStatus::event:
      return "an event was found";
    case SolverStatus::step_too_small:
      return "the step size that the tolerance asks for fell below rounding";
    case SolverStatus::no_convergence:
      return "the implicit equations of a step could not be solved";
    case SolverStatus::too_many_steps:
      return "the number of steps between two stops was exhausted";
    case SolverStatus::non_finite:
      return "a derivative, crossing function or state became infinite or not a number";
    case SolverStatus::block_fault:
      return "a block reported a fault";
    case SolverStatus::wrong_answer:
      return "the integrator claimed success, but its time or state cannot be right";
    case SolverStatus::bad_stop:
      return "the stop time lies in the past or is not finite";
  }
  return "unknown solver status";
}

namespace {

void throw_if_any_problem(const SolverOptions& options, const OdeSystem& system) {
  std::vector<std::string> found = options.problems(system.states);
  if (system.states < 0 || system.crossings < 0)
    found.push_back("the numbers of states and crossings cannot be negative");
  if (system.derivatives == nullptr) found.push_back("the system has no derivatives");
  if (system.crossings > 0 && system.crossing_values == nullptr)
    found.push_back("the system has no crossing_values");
  if (!found.empty()) throw std::invalid_argument(fmt::format("solver: {}", fmt::join(found, "; ")));
}

std::unique_ptr<Stepper> make_stepper(const SolverOptions& options, const OdeSystem& system) {
  // Without states there are no implicit equations, and CVODE requires at least one.
  if (options.method == Method::dopri5 || system.states == 0) return make_dormand_prince(options, system);
  return make_cvode_stepper(options, system);
}

}  // namespace

Solver::Solver(const SolverOptions& options, const OdeSystem& system)
    : Solver((throw_if_any_problem(options, system), make_stepper(options, system)), options, system) {}

Solver::Solver(std::unique_ptr<Stepper> method, const SolverOptions& options, const OdeSystem& system)
    : stepper_(std::move(method)),
      events_(system, options.crossing_samples),
      x_between_(static_cast<size_t>(system.states)),
      x_(x_between_.data()),
      states_(system.states),
      maximum_trials_(options.maximum_steps_between_stops) {}

Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;
Solver::~Solver() = default;

void Solver::start(double t, const double* x) {
  stepper_->start(t, x);
  events_.forget();
  stand_at_restart(t);
}

void Solver::restart(double t, const double* x) {
  stepper_->restart(t, x);
  stand_at_restart(t);
}

void Solver::stand_at_restart(double t) {
  t_ = t;
  x_ = stepper_->x_end();
  signs_known_ = events_.empty();
  trials_at_stop_ = statistics().trials();
}

bool Solver::can_be_archived() const { return x_ == stepper_->x_end() && stepper_->can_be_archived(); }
void Solver::archive(StateArchive& a) {
  stepper_->archive(a);
  events_.archive(a);
  a.members(t_, signs_known_, trials_at_stop_);
  if (a.reads()) x_ = stepper_->x_end();
}

double Solver::step_begin() const { return stepper_->t_begin(); }
void Solver::interpolate(double t, double* x) const { stepper_->interpolate(t, x); }
int Solver::worst_state() const { return stepper_->worst_state(); }
const SolverStatistics& Solver::statistics() const { return stepper_->statistics; }

namespace {

SolverStatus status_of(EventFinder::Found found) {
  switch (found) {
    case EventFinder::Found::nothing:
      return SolverStatus::stepped;
    case EventFinder::Found::event:
      return SolverStatus::event;
    case EventFinder::Found::fault:
      return SolverStatus::block_fault;
    case EventFinder::Found::non_finite:
      return SolverStatus::non_finite;
  }
  return SolverStatus::wrong_answer;
}

}  // namespace

Advance Solver::advance(double t_stop, const Crossing* wanted) {
  Advance result = step(t_stop, wanted);
  while (result.status == SolverStatus::stepped) result = step(t_stop, wanted);
  return result;
}

Advance Solver::step(double t_stop, const Crossing* wanted) {
  events_.clear_fired();
  if (!(t_stop >= t_ && std::isfinite(t_stop))) return {SolverStatus::bad_stop, t_};
  if (t_ == t_stop) return {SolverStatus::reached_stop, t_};
  if (!signs_known_) {
    const SolverStatus status = status_of(events_.begin(*stepper_, t_, x_));
    if (status != SolverStatus::stepped) return {status, t_};
    signs_known_ = true;
  }
  // After an event without a restart, the rest of the integrator's step has not been searched yet.
  if (t_ == stepper_->t_end()) {
    const SolverStatus status = take_step(t_stop);
    if (status != SolverStatus::stepped) return {status, t_};
  }
  const double to = std::fmin(stepper_->t_end(), t_stop);
  if (!events_.empty()) {
    const SolverStatus status = status_of(events_.scan(*stepper_, t_, to, wanted));
    if (status == SolverStatus::event) return stand_at_event();
    if (status != SolverStatus::stepped) return {status, t_};
  }
  return stand_at(to, t_stop);
}

/// One step of the integrator, with a check of its result: the time must have moved, not too far, and the
/// state must be finite. (CVODE has returned success with a step of zero.)
SolverStatus Solver::take_step(double t_stop) {
  if (statistics().trials() - trials_at_stop_ >= maximum_trials_) return SolverStatus::too_many_steps;
  const SolverStatus status = stepper_->step(t_stop);
  if (status != SolverStatus::stepped) return status;
  const bool time_is_right =
      stepper_->t_begin() == t_ && stepper_->t_end() > t_ && stepper_->t_end() <= t_stop;
  return time_is_right && stepper_->end_is_finite() ? SolverStatus::stepped : SolverStatus::wrong_answer;
}

Advance Solver::stand_at_event() {
  ++stepper_->statistics.events;
  t_ = events_.time();
  std::copy_n(events_.state(), x_between_.size(), x_between_.begin());
  x_ = x_between_.data();
  trials_at_stop_ = statistics().trials();
  return {SolverStatus::event, t_};
}

Advance Solver::stand_at(double t, double t_stop) {
  t_ = t;
  x_ = stepper_->x_end();
  if (t != stepper_->t_end()) {
    stepper_->interpolate(t, x_between_.data());
    x_ = x_between_.data();
  }
  if (t < t_stop) return {SolverStatus::stepped, t_};
  trials_at_stop_ = statistics().trials();
  return {SolverStatus::reached_stop, t_};
}

}  // namespace loopwright
