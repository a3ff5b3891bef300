/// Systems of nonlinear equations, solved in place, for algebraic loops.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace loopwright {

/// n equations residual(y) = 0 in n unknowns. For a loop, y are the torn signals and the residual is their
/// change in one pass around the loop. Must have no side effects; returns false if a block faulted at y.
struct AlgebraicSystem {
  void* self = nullptr;
  int unknowns = 0;
  bool (*residual)(void* self, const double* y, double* residual) = nullptr;
};

struct NewtonOptions {
  double tolerance = 1e-10;      ///< largest |residual| of a solution, relative to |y| or 0.001 typical
  int maximum_iterations = 100;  ///< a loop that needs more has no solution near the guess
  std::vector<double> typical;   ///< usual magnitude of each unknown, for difference quotients; empty: 1
};

enum class NewtonStatus : uint8_t {
  converged,
  too_many_iterations,
  no_solution_found,  ///< the residual cannot be made smaller from here
  singular_jacobian,  ///< the equations do not determine the unknowns
  non_finite,         ///< a residual became non-finite
  block_fault         ///< a block refused the evaluation
};
std::string_view to_text(NewtonStatus status);

struct NewtonResult {
  NewtonStatus status = NewtonStatus::converged;
  int iterations = 0;
  int evaluations = 0;         ///< of the residual, including those for Jacobians
  double residual_norm = 0.0;  ///< largest |residual| at the best y found, scaled like the tolerance
  int worst_unknown = -1;      ///< the unknown with this residual
};

/// KINSOL's Newton method with line search and a dense Jacobian by differences. After construction the solver
/// itself does not allocate, throw or format text.
class NewtonSolver {
 public:
  /// Throws std::invalid_argument if the options or the system are invalid.
  NewtonSolver(const NewtonOptions& options, const AlgebraicSystem& system);
  NewtonSolver(NewtonSolver&&) noexcept;
  NewtonSolver& operator=(NewtonSolver&&) noexcept;
  ~NewtonSolver();

  /// y: the initial guess, best the last solution; replaced by the solution. Unchanged unless converged.
  NewtonResult solve(std::span<double> y);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace loopwright
