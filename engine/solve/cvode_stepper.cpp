// CVODE, one internal step per call: Hindmarsh et al., ACM Trans. Math. Softw. 31 (2005), and the user guide
// of version 6.
#include "engine/solve/cvode_stepper.h"

#include <cvode/cvode.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/solve/sundials.h"

namespace loopwright {

namespace {

using sundials::own;
using sundials::Owner;
using sundials::require;

struct ReleaseCvode {
  void operator()(void* memory) const { CVodeFree(&memory); }
};

class CvodeStepper final : public Stepper {
 public:
  CvodeStepper(const SolverOptions& options, const OdeSystem& system);
  SolverStatus step(double t_stop) override;
  int worst_state() const override;
  /// CVODE keeps its history in its own memory: archiving is only possible before it has one.
  bool can_be_archived() const override { return fresh_; }
  void archive(StateArchive& a) override {
    Stepper::archive(a);
    if (a.reads()) forget_history();
  }

 private:
  void forget_all() override { forget_history(); }
  void forget_history() override {
    fresh_ = true;
    failed_at_ = std::numeric_limits<double>::infinity();
  }
  void attach_newton();
  void attach_fixed_point();
  void rehearse();
  SolverStatus nudge(double t_stop);
  SolverStatus failure(int flag);
  SolverStatus swallowed();
  void count();
  double unit(size_t i, double x) const {
    return absolute_tolerance_[i] + relative_tolerance_ * std::fabs(x);
  }
  bool evaluate_finite(double t, const double* x, double* rate);
  bool difference_quotients(double* x, const double* rate, SUNMatrix jacobian, double t, double* trial_rate);
  void interpolate_within(double t, double* x) const override;

  static int derivatives(double t, N_Vector x, N_Vector rate, void* self);
  static int jacobian(double t, N_Vector x, N_Vector rate, SUNMatrix jacobian, void* self, N_Vector work,
                      N_Vector, N_Vector);

  double t_stop_ = 0.0;
  bool rehearsing_ = false;  ///< the constructor makes a step without the system
  bool fresh_ = true;        ///< CVODE has not yet received the present state
  bool nudged_ = false;      ///< the last step was made without CVODE
  int non_finite_state_ = -1;
  double failed_at_ = std::numeric_limits<double>::infinity();  ///< [s] time of the last failed evaluation
  SolverStatus failed_as_ = SolverStatus::non_finite;
  long error_test_failures_ = 0, convergence_failures_ = 0;  ///< at the last query of CVODE
  std::vector<double> trial_, nudge_rate_;
  mutable std::vector<double> errors_;

  // In order of creation; the context must outlive the rest.
  Owner<SUNContext> context_ = sundials::make_context();
  Owner<N_Vector> end_, view_;
  Owner<SUNMatrix> jacobian_;
  Owner<SUNLinearSolver> linear_solver_;
  Owner<SUNNonlinearSolver> nonlinear_solver_;
  std::unique_ptr<void, ReleaseCvode> cvode_;
};

CvodeStepper::CvodeStepper(const SolverOptions& options, const OdeSystem& system)
    : Stepper(options, system), trial_(states_), nudge_rate_(states_), errors_(states_) {
  const auto length = static_cast<sunindextype>(states_);
  end_ = own(N_VMake_Serial(length, trial_.data(), context_.get()));
  view_ = own(N_VMake_Serial(length, errors_.data(), context_.get()));
  const bool stiff = options.method == Method::cvode_bdf;
  cvode_.reset(CVodeCreate(stiff ? CV_BDF : CV_ADAMS, context_.get()));
  if (cvode_ == nullptr) throw std::bad_alloc();
  void* const cvode = cvode_.get();
  require(CVodeSetErrHandlerFn(cvode, sundials::print_nothing, nullptr), "CVodeSetErrHandlerFn");
  require(CVodeInit(cvode, derivatives, 0.0, end_.get()), "CVodeInit");
  require(CVodeSetUserData(cvode, this), "CVodeSetUserData");
  {
    auto tolerances = absolute_tolerance_;
    const Owner<N_Vector> absolute = own(N_VMake_Serial(length, tolerances.data(), context_.get()));
    require(CVodeSVtolerances(cvode, relative_tolerance_, absolute.get()), "CVodeSVtolerances");
  }
  require(CVodeSetInitStep(cvode, options.initial_step), "CVodeSetInitStep");
  if (std::isfinite(options.maximum_step))
    require(CVodeSetMaxStep(cvode, options.maximum_step), "CVodeSetMaxStep");
  require(CVodeSetMaxHnilWarns(cvode, -1), "CVodeSetMaxHnilWarns");
  stiff ? attach_newton() : attach_fixed_point();
  rehearse();
}

void CvodeStepper::attach_newton() {
  const auto n = static_cast<sunindextype>(states_);
  jacobian_ = own(SUNDenseMatrix(n, n, context_.get()));
  linear_solver_ = own(SUNLinSol_Dense(end_.get(), jacobian_.get(), context_.get()));
  require(CVodeSetLinearSolver(cvode_.get(), linear_solver_.get(), jacobian_.get()), "CVodeSetLinearSolver");
  require(CVodeSetJacFn(cvode_.get(), jacobian),
          "CVodeSetJacFn");  // its own difference quotients allocate on every call
}

void CvodeStepper::attach_fixed_point() {
  nonlinear_solver_ = own(SUNNonlinSol_FixedPoint(end_.get(), 0, context_.get()));
  require(CVodeSetNonlinearSolver(cvode_.get(), nonlinear_solver_.get()), "CVodeSetNonlinearSolver");
}

/// CVODE allocates some of its memory in its first step. This makes a step on x' = 0, so that no run has to
/// allocate.
void CvodeStepper::rehearse() {
  rehearsing_ = true;
  double t = 0.0;
  require(CVode(cvode_.get(), 1.0, end_.get(), &t, CV_ONE_STEP), "its first step");
  rehearsing_ = false;
}

SolverStatus CvodeStepper::step(double t_stop) {
  t_stop_ = t_stop;
  // CVODE rejects intervals of a few rounding errors, and treats a stop time as reached from about this
  // distance.
  if (t_stop - t_end_ <= 200.0 * rounding(t_end_, t_stop)) return nudge(t_stop);
  void* const cvode = cvode_.get();
  if (fresh_) {
    copy(x_end_.data(), trial_.data());
    error_test_failures_ = convergence_failures_ = 0;
    if (CVodeReInit(cvode, t_end_, end_.get()) != CV_SUCCESS) return fail(SolverStatus::wrong_answer);
    fresh_ = false;
  }
  if (CVodeSetStopTime(cvode, t_stop) != CV_SUCCESS) return fail(SolverStatus::wrong_answer);
  trouble_ = SolverStatus::no_convergence;
  double t = t_end_;
  const int flag = CVode(cvode, t_stop, end_.get(), &t, CV_ONE_STEP);
  count();
  if (flag < 0) return fail(failure(flag));
  if (!(t > t_end_)) return fail(swallowed());  // CVODE reported success
  if (std::fabs(t - t_stop) <= 8.0 * rounding(t, t_stop)) {
    t = t_stop;
  } else if (flag == CV_TSTOP_RETURN) {
    return fail(SolverStatus::wrong_answer);
  } else {
    double h = 0.0;
    CVodeGetLastStep(cvode, &h);
    statistics.smallest_step = std::fmin(statistics.smallest_step, h);
  }
  nudged_ = false;
  accept(t, trial_);
  N_VSetArrayPointer(trial_.data(), end_.get());
  return SolverStatus::stepped;
}

/// An explicit Euler step over a distance where its error is far below rounding.
SolverStatus CvodeStepper::nudge(double t_stop) {
  trouble_ = SolverStatus::non_finite;
  if (!evaluate_finite(t_end_, x_end_.data(), nudge_rate_.data())) return fail(trouble_);
  for (size_t i = 0; i < states_; ++i) trial_[i] = x_end_[i] + (t_stop - t_end_) * nudge_rate_[i];
  fresh_ = nudged_ = true;
  accept(t_stop, trial_);
  N_VSetArrayPointer(trial_.data(), end_.get());
  return SolverStatus::stepped;
}

SolverStatus CvodeStepper::failure(int flag) {
  switch (flag) {
    case CV_TOO_MUCH_ACC:
    case CV_ERR_FAILURE:
      return SolverStatus::step_too_small;
    case CV_CONV_FAILURE:
    case CV_LSETUP_FAIL:
    case CV_LSOLVE_FAIL:
    case CV_RHSFUNC_FAIL:
    case CV_FIRST_RHSFUNC_ERR:
    case CV_REPTD_RHSFUNC_ERR:
    case CV_UNREC_RHSFUNC_ERR:
      return trouble_;
    default:
      return SolverStatus::wrong_answer;
  }
}

/// The step has become too small for t: because evaluations just ahead fail, or else because of its error.
SolverStatus CvodeStepper::swallowed() {
  const bool just_ahead = std::fabs(failed_at_ - t_end_) < 1e4 * rounding(t_end_, failed_at_);
  trouble_ = just_ahead ? failed_as_ : SolverStatus::step_too_small;
  return trouble_;
}

void CvodeStepper::count() {
  long errors = 0, failures = 0;
  CVodeGetNumErrTestFails(cvode_.get(), &errors);
  CVodeGetNumStepSolveFails(cvode_.get(), &failures);
  statistics.error_test_failures += errors - error_test_failures_;
  statistics.convergence_failures += failures - convergence_failures_;
  error_test_failures_ = errors;
  convergence_failures_ = failures;
}

/// As evaluate(), but every rate must be finite: CVODE itself would propagate a NaN.
bool CvodeStepper::evaluate_finite(double t, const double* x, double* rate) {
  if (evaluate(t, x, rate)) {
    size_t i = 0;
    while (i < states_ && std::isfinite(rate[i])) ++i;
    if (i == states_) return true;
    trouble_ = SolverStatus::non_finite;
    non_finite_state_ = static_cast<int>(i);
  }
  failed_at_ = t;
  failed_as_ = trouble_;
  return false;
}

int CvodeStepper::derivatives(double t, N_Vector x, N_Vector rate, void* self) {
  auto& stepper = *static_cast<CvodeStepper*>(self);
  if (stepper.rehearsing_) return N_VConst(0.0, rate), 0;
  // The last step of CVODE may exceed the stop time by rounding, where the right-hand side may be different.
  const double within = std::fmin(t, stepper.t_stop_);
  return stepper.evaluate_finite(within, N_VGetArrayPointer(x), N_VGetArrayPointer(rate)) ? 0 : 1;
}

int CvodeStepper::jacobian(double t, N_Vector x, N_Vector rate, SUNMatrix jacobian, void* self, N_Vector work,
                           N_Vector, N_Vector) {
  auto& stepper = *static_cast<CvodeStepper*>(self);
  if (stepper.rehearsing_) return SUNMatZero(jacobian);
  const double within = std::fmin(t, stepper.t_stop_);
  const bool good = stepper.difference_quotients(N_VGetArrayPointer(x), N_VGetArrayPointer(rate), jacobian,
                                                 within, N_VGetArrayPointer(work));
  return good ? 0 : 1;
}

/// ∂f/∂x by forward differences. Each increment is the larger of √ε |x| and a value that changes f
/// significantly over the next step.
bool CvodeStepper::difference_quotients(double* x, const double* rate, SUNMatrix jacobian, double t,
                                        double* trial_rate) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  ++statistics.jacobian_evaluations;
  double h = 0.0, norm = 0.0;
  CVodeGetCurrentStep(cvode_.get(), &h);
  for (size_t i = 0; i < states_; ++i) norm += (rate[i] / unit(i, x[i])) * (rate[i] / unit(i, x[i]));
  norm = std::sqrt(norm / static_cast<double>(states_));
  const double least =
      norm > 0.0 ? 1000.0 * std::fabs(h) * epsilon * static_cast<double>(states_) * norm : 1.0;
  for (size_t j = 0; j < states_; ++j) {
    const double here = x[j];
    x[j] = here + std::fmax(std::sqrt(epsilon) * std::fabs(here), least * unit(j, here));
    const double increment = x[j] - here;
    const bool good = evaluate_finite(t, x, trial_rate);
    x[j] = here;
    if (!good) return false;
    double* column = SUNDenseMatrix_Column(jacobian, static_cast<sunindextype>(j));
    for (size_t i = 0; i < states_; ++i) column[i] = (trial_rate[i] - rate[i]) / increment;
  }
  return true;
}

int CvodeStepper::worst_state() const {
  if (trouble_ == SolverStatus::block_fault) return -1;
  if (trouble_ == SolverStatus::non_finite) return non_finite_state_;
  if (fresh_) return -1;
  N_VSetArrayPointer(errors_.data(), view_.get());
  if (CVodeGetEstLocalErrors(cvode_.get(), view_.get()) != CV_SUCCESS) return -1;
  int worst = -1;
  double largest = 0.0;
  for (size_t i = 0; i < states_; ++i) {
    const double error = std::fabs(errors_[i]) / unit(i, x_end_[i]);
    if (error > largest) largest = error, worst = static_cast<int>(i);
  }
  return worst;
}

void CvodeStepper::interpolate_within(double t, double* x) const {
  if (nudged_) return copy(x_end_.data(), x);
  N_VSetArrayPointer(x, view_.get());
  const int flag = CVodeGetDky(cvode_.get(), t, 0, view_.get());
  N_VSetArrayPointer(errors_.data(), view_.get());
  if (flag == CV_SUCCESS) return;
  for (size_t i = 0; i < states_; ++i) x[i] = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::unique_ptr<Stepper> make_cvode_stepper(const SolverOptions& options, const OdeSystem& system) {
  return std::make_unique<CvodeStepper>(options, system);
}

}  // namespace loopwright
