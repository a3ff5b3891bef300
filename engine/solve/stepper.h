/// Accepted steps without events: the common interface of the integration methods for the Solver.
#pragma once
#include <cmath>
#include <limits>
#include <vector>

#include "engine/solve/solver.h"
#include "engine/solve/state_archive.h"

namespace loopwright {

/// The solution over the last accepted step, and the computation of the next. Steppers are allocated on the
/// heap and not moved, as integrators store their address.
class Stepper {
 public:
  Stepper(const SolverOptions& options, const OdeSystem& system)
      : system_(system),
        states_(static_cast<size_t>(system.states)),
        relative_tolerance_(options.relative_tolerance),
        absolute_tolerance_(options.absolute_tolerances.empty()
                                ? std::vector<double>(states_, options.absolute_tolerance)
                                : options.absolute_tolerances),
        x_begin_(states_),
        x_end_(states_) {}
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;
  virtual ~Stepper() = default;

  /// Clears the history and every estimate.
  void start(double t, const double* x) {
    statistics = {};
    stand_at(t, x);
    forget_all();
  }

  /// Clears the history; an estimate of the step size may be kept.
  void restart(double t, const double* x) {
    ++statistics.restarts;
    stand_at(t, x);
    forget_history();
  }

  /// Makes one accepted step from t_end() to at most t_stop > t_end(). Returns `stepped`, or the reason for a
  /// failure; the solution is then at t_end() as before, without its last step. The state at the old t_end()
  /// stays at its address, as the state at the new t_begin().
  virtual SolverStatus step(double t_stop) = 0;

  /// The state at t in [t_begin(), t_end()].
  void interpolate(double t, double* x) const {
    if (t == t_end_) return copy(x_end_.data(), x);
    if (t == t_begin_) return copy(x_begin_.data(), x);
    interpolate_within(t, x);
  }

  virtual int worst_state() const = 0;

  /// Whether the solution can be archived at this point and continued elsewhere with the same bits.
  virtual bool can_be_archived() const { return false; }
  /// Everything on which the next steps depend.
  virtual void archive(StateArchive& a) {
    auto& s = statistics;
    a.members(t_begin_, t_end_, x_begin_, x_end_);
    a.members(s.steps, s.error_test_failures, s.convergence_failures, s.derivative_evaluations,
              s.jacobian_evaluations, s.crossing_evaluations, s.restarts, s.events, s.stiff_steps, s.stiff,
              s.stiffest_state, s.smallest_step);
  }

  double t_begin() const { return t_begin_; }
  double t_end() const { return t_end_; }
  const double* x_end() const { return x_end_.data(); }
  bool end_is_finite() const {
    double zero = 0.0;
    for (double value : x_end_) zero += 0.0 * value;  // 0 · ∞ and 0 · NaN are NaN
    return zero == 0.0;
  }

  SolverStatistics statistics;

 protected:
  virtual void forget_all() = 0;
  virtual void forget_history() = 0;
  virtual void interpolate_within(double t, double* x) const = 0;

  void copy(const double* from, double* to) const { copy_states(from, states_, to); }

  /// The end of the last step becomes the beginning of this one, `x` (swapped, not copied) its end at t.
  void accept(double t, std::vector<double>& x) {
    ++statistics.steps;
    t_begin_ = t_end_;
    t_end_ = t;
    x_begin_.swap(x_end_);
    x_end_.swap(x);
  }

  /// After a failed step there is no dense output.
  SolverStatus fail(SolverStatus status) {
    t_begin_ = t_end_;
    x_begin_ = x_end_;
    return status;
  }

  /// rate := f(t, x). Stores the reason of a failure in `trouble_`.
  bool evaluate(double t, const double* x, double* rate) {
    ++statistics.derivative_evaluations;
    if (system_.derivatives(system_.self, t, x, rate)) return true;
    trouble_ = SolverStatus::block_fault;
    return false;
  }

  const OdeSystem system_;
  const size_t states_;
  const double relative_tolerance_;
  const std::vector<double> absolute_tolerance_;
  double t_begin_ = 0.0, t_end_ = 0.0;
  std::vector<double> x_begin_, x_end_;
  SolverStatus trouble_ = SolverStatus::non_finite;  ///< of the last failed evaluation

 private:
  void stand_at(double t, const double* x) {
    t_begin_ = t_end_ = t;
    copy(x, x_end_.data());
    copy(x, x_begin_.data());
  }
};

/// The spacing of doubles at the larger of |a| and |b|, at least the smallest normal number.
inline double rounding(double a, double b) {
  const double size = std::fmax(std::fabs(a), std::fabs(b));
  return std::fmax(size * std::numeric_limits<double>::epsilon(), std::numeric_limits<double>::min());
}

}  // namespace loopwright
