// KINSOL: Hindmarsh et al., ACM Trans. Math. Softw. 31 (2005); line search after Dennis & Schnabel, Numerical
// Methods for Unconstrained Optimization and Nonlinear Equations, section 6.3.
#include "engine/solve/newton.h"

#include <fmt/format.h>
#include <kinsol/kinsol.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/solve/sundials.h"

namespace loopwright {

std::string_view to_text(NewtonStatus status) {
  switch (status) {
    case NewtonStatus::converged:
      return "the equations were solved";
    case NewtonStatus::too_many_iterations:
      return "no solution within the permitted iterations";
    case NewtonStatus::no_solution_found:
      return "the residual cannot be made smaller: there is no solution nearby";
    case NewtonStatus::singular_jacobian:
      return "the equations do not determine the unknowns (singular Jacobian)";
    case NewtonStatus::non_finite:
      return "a residual became infinite or not a number";
    case NewtonStatus::block_fault:
      return "a block reported a fault";
  }
  return "unknown status";
}

namespace {

using sundials::own;
using sundials::Owner;
using sundials::require;

/// A solution smaller than this fraction of its typical size counts as zero.
constexpr double negligible_part = 1e-3;

struct ReleaseKinsol {
  void operator()(void* memory) const { KINFree(&memory); }
};

void say_no_progress(const char*, const char*, char*, void*) {}

void throw_if_senseless(const NewtonOptions& options, const AlgebraicSystem& system) {
  const char* complaint = nullptr;
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  if (system.unknowns < 1 || system.residual == nullptr)
    complaint = "the system has no unknowns or no residual";
  if (!positive(options.tolerance)) complaint = "tolerance must be positive";
  if (options.maximum_iterations < 1) complaint = "maximum_iterations must be at least 1";
  if (!options.typical.empty() && std::ssize(options.typical) != system.unknowns)
    complaint = "typical needs one size an unknown";
  if (!std::all_of(options.typical.begin(), options.typical.end(), positive))
    complaint = "typical sizes must be positive";
  if (complaint != nullptr) throw std::invalid_argument(fmt::format("Newton solver: {}", complaint));
}

}  // namespace

struct NewtonSolver::Work {
  Work(const NewtonOptions& options, const AlgebraicSystem& system_to_solve);
  NewtonResult solve(std::span<double> y);

  void measure(NewtonResult& result);
  double size(size_t i) const { return std::fmax(std::fabs(y[i]), negligible_part * typical[i]); }
  bool evaluate(const double* at, double* into);
  bool difference_quotients(double* at, const double* value, SUNMatrix into, double* trial);
  bool is_determined();
  double evaluate_beside(double* at, size_t j, double distance, double* trial);
  NewtonStatus status_of(int flag) const;
  static int residual_function(N_Vector y, N_Vector residual, void* self);
  static int jacobian_function(N_Vector y, N_Vector residual, SUNMatrix jacobian, void* self, N_Vector work,
                               N_Vector);

  const AlgebraicSystem system;
  const size_t n;
  const double tolerance;
  const std::vector<double> typical;
  std::vector<double> y, scale, residual, beside, weight;
  bool was_determined = false;                      ///< the determinacy of some solution has been checked
  NewtonStatus trouble = NewtonStatus::non_finite;  ///< of the last failed evaluation
  int evaluations = 0;

  // In order of creation; the context must outlive the rest.
  Owner<SUNContext> context = sundials::make_context();
  Owner<N_Vector> y_vector, scale_vector;
  Owner<SUNMatrix> jacobian;
  Owner<SUNLinearSolver> linear_solver;
  std::unique_ptr<void, ReleaseKinsol> kinsol;
};

NewtonSolver::Work::Work(const NewtonOptions& options, const AlgebraicSystem& system_to_solve)
    : system(system_to_solve),
      n(static_cast<size_t>(system.unknowns)),
      tolerance(options.tolerance),
      typical(options.typical.empty() ? std::vector<double>(n, 1.0) : options.typical),
      y(n),
      scale(n, 1.0),
      residual(n),
      beside(n),
      weight(n * n) {
  const auto length = static_cast<sunindextype>(n);
  y_vector = own(N_VMake_Serial(length, y.data(), context.get()));
  scale_vector = own(N_VMake_Serial(length, scale.data(), context.get()));
  jacobian = own(SUNDenseMatrix(length, length, context.get()));
  linear_solver = own(SUNLinSol_Dense(y_vector.get(), jacobian.get(), context.get()));
  kinsol.reset(KINCreate(context.get()));
  if (kinsol == nullptr) throw std::bad_alloc();
  void* const memory = kinsol.get();
  require(KINSetErrHandlerFn(memory, sundials::print_nothing, nullptr), "KINSetErrHandlerFn");
  require(KINSetInfoHandlerFn(memory, say_no_progress, nullptr), "KINSetInfoHandlerFn");
  require(KINInit(memory, residual_function, y_vector.get()), "KINInit");
  require(KINSetUserData(memory, this), "KINSetUserData");
  require(KINSetLinearSolver(memory, linear_solver.get(), jacobian.get()), "KINSetLinearSolver");
  require(KINSetJacFn(memory, jacobian_function),
          "KINSetJacFn");  // its own difference quotients allocate on every call
  require(KINSetNumMaxIters(memory, options.maximum_iterations), "KINSetNumMaxIters");
  require(KINSetFuncNormTol(memory, tolerance), "KINSetFuncNormTol");
  require(KINSetMaxSetupCalls(memory, 1),
          "KINSetMaxSetupCalls");  // loops are small: a new Jacobian each time
  require(KINSetMaxNewtonStep(memory, 1e100), "KINSetMaxNewtonStep");  // else 0 may change by at most 1
}

bool NewtonSolver::Work::evaluate(const double* at, double* into) {
  ++evaluations;
  trouble = NewtonStatus::block_fault;
  if (!system.residual(system.self, at, into)) return false;
  trouble = NewtonStatus::non_finite;
  return std::all_of(into, into + n, [](double value) { return std::isfinite(value); });
}

int NewtonSolver::Work::residual_function(N_Vector y_vector, N_Vector residual, void* self) {
  return static_cast<Work*>(self)->evaluate(N_VGetArrayPointer(y_vector), N_VGetArrayPointer(residual)) ? 0
                                                                                                        : 1;
}

int NewtonSolver::Work::jacobian_function(N_Vector y_vector, N_Vector residual, SUNMatrix jacobian,
                                          void* self, N_Vector work, N_Vector) {
  const bool good = static_cast<Work*>(self)->difference_quotients(
      N_VGetArrayPointer(y_vector), N_VGetArrayPointer(residual), jacobian, N_VGetArrayPointer(work));
  return good ? 0 : 1;
}

/// ∂residual/∂y by forward differences, or backward differences if a forward step leaves the domain. If no
/// residual changes at all, the typical size was too small compared with the residual: longer steps are
/// tried.
bool NewtonSolver::Work::difference_quotients(double* at, const double* value, SUNMatrix into,
                                              double* trial) {
  const double relative = std::sqrt(std::numeric_limits<double>::epsilon());
  for (size_t j = 0; j < n; ++j) {
    double* column = SUNDenseMatrix_Column(into, static_cast<sunindextype>(j));
    double distance = relative * std::fmax(std::fabs(at[j]), typical[j]);
    bool moved = false;
    for (int attempt = 0; attempt < 4 && !moved; ++attempt, distance *= 1e3) {
      const double increment = evaluate_beside(at, j, distance, trial);
      if (increment == 0.0 && attempt == 0) return false;
      if (increment == 0.0) break;
      for (size_t i = 0; i < n; ++i) {
        column[i] = (trial[i] - value[i]) / increment;
        moved = moved || column[i] != 0.0;
      }
    }
  }
  return true;
}

/// Whether the solution is locally unique: the Jacobian there has full rank. Gaussian elimination; a pivot
/// counts as zero if it is less than the rounding errors of the difference quotients from which it was
/// computed.
bool NewtonSolver::Work::is_determined() {
  constexpr double lost = 1e-7;  // difference quotients have half the digits of a double
  if (!difference_quotients(y.data(), residual.data(), jacobian.get(), beside.data()))
    return true;  // cannot be decided here
  double** const column = SUNDenseMatrix_Cols(jacobian.get());
  const auto weight_at = [&](size_t i, size_t j) -> double& { return weight[j * n + i]; };
  for (size_t j = 0; j < n; ++j)  // the residual is a difference: G(y) - y
    for (size_t i = 0; i < n; ++i)
      weight_at(i, j) = i == j ? std::fabs(column[j][i] + 1.0) + 1.0 : std::fabs(column[j][i]);
  for (size_t k = 0; k < n; ++k) {
    size_t best = k;
    double share = 0.0;
    for (size_t i = k; i < n; ++i) {
      const double part = weight_at(i, k) > 0.0 ? std::fabs(column[k][i]) / weight_at(i, k) : 0.0;
      if (part > share) share = part, best = i;
    }
    if (!(share > lost)) return false;
    for (size_t j = k; j < n; ++j)
      std::swap(column[j][k], column[j][best]), std::swap(weight_at(k, j), weight_at(best, j));
    for (size_t i = k + 1; i < n; ++i) {
      const double factor = column[k][i] / column[k][k];
      for (size_t j = k; j < n; ++j) {
        column[j][i] -= factor * column[j][k];
        weight_at(i, j) += std::fabs(factor) * weight_at(k, j);
      }
    }
  }
  return true;
}

/// The residual with unknown j increased by a distance or, if that fails, decreased. Returns the change; 0:
/// both fail.
double NewtonSolver::Work::evaluate_beside(double* at, size_t j, double distance, double* trial) {
  const double here = at[j];
  for (const double there : {here + distance, here - distance}) {
    at[j] = there;
    const bool good = evaluate(at, trial);
    at[j] = here;
    if (good) return there - here;
  }
  return 0.0;
}

/// Records the residual at y if it is the smallest so far.
void NewtonSolver::Work::measure(NewtonResult& result) {
  if (!evaluate(y.data(), residual.data())) return;
  double norm = 0.0;
  int worst = 0;
  for (size_t i = 0; i < n; ++i) {
    const double part = std::fabs(residual[i]) / size(i);
    if (part > norm) norm = part, worst = static_cast<int>(i);
  }
  if (norm < result.residual_norm || norm <= tolerance)
    result.residual_norm = norm, result.worst_unknown = worst;
}

NewtonStatus NewtonSolver::Work::status_of(int flag) const {
  switch (flag) {
    case KIN_MAXITER_REACHED:
      return NewtonStatus::too_many_iterations;
    case KIN_LINSOLV_NO_RECOVERY:
    case KIN_LSETUP_FAIL:
    case KIN_LSOLVE_FAIL:
      return NewtonStatus::singular_jacobian;
    case KIN_SYSFUNC_FAIL:
    case KIN_FIRST_SYSFUNC_ERR:
    case KIN_REPTD_SYSFUNC_ERR:
      return trouble;
    default:
      return NewtonStatus::no_solution_found;
  }
}

NewtonResult NewtonSolver::Work::solve(std::span<double> guess) {
  NewtonResult result;
  result.residual_norm = std::numeric_limits<double>::infinity();
  evaluations = 0;
  std::copy_n(guess.begin(), n, y.begin());
  // Scales come from the guess. A solution of very different size is refined with its own scales.
  for (int pass = 0; pass < 3; ++pass) {
    for (size_t i = 0; i < n; ++i) scale[i] = 1.0 / size(i);
    const int flag =
        KINSol(kinsol.get(), y_vector.get(), KIN_LINESEARCH, scale_vector.get(), scale_vector.get());
    long iterations = 0;
    KINGetNumNonlinSolvIters(kinsol.get(), &iterations);
    result.iterations += static_cast<int>(iterations);
    // KINSOL also reports success if its steps have become short: only the residual is conclusive.
    result.status = flag < 0 ? status_of(flag) : NewtonStatus::no_solution_found;
    measure(result);
    if (result.residual_norm <= tolerance) result.status = NewtonStatus::converged;
    if (flag < 0 || result.status == NewtonStatus::converged) break;
  }
  // If the guess is already a solution, no Jacobian has been computed yet.
  if (result.status == NewtonStatus::converged && (result.iterations == 0 || !was_determined)) {
    was_determined = is_determined();
    if (!was_determined) result.status = NewtonStatus::singular_jacobian;
  }
  result.evaluations = evaluations;
  if (result.status == NewtonStatus::converged) std::copy_n(y.begin(), n, guess.begin());
  return result;
}

NewtonSolver::NewtonSolver(const NewtonOptions& options, const AlgebraicSystem& system)
    : work_((throw_if_senseless(options, system), std::make_unique<Work>(options, system))) {}
NewtonSolver::NewtonSolver(NewtonSolver&&) noexcept = default;
NewtonSolver& NewtonSolver::operator=(NewtonSolver&&) noexcept = default;
NewtonSolver::~NewtonSolver() = default;

NewtonResult NewtonSolver::solve(std::span<double> y) { return work_->solve(y); }

}  // namespace loopwright
