/// Systems of nonlinear equations, solved in place: algebraic loops.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace loopwright {

/// n equations residual(y) = 0 in n unknowns. For a loop, y are the torn signals and the residual is what one
/// pass around the loop changes them by. Side-effect free; returns false if a block faulted at y.
struct AlgebraicSystem {
  void* self = nullptr;
  int unknowns = 0;
  bool (*residual)(void* self, const double* y, double* residual) = nullptr;
};

struct NewtonOptions {
  double tolerance = 1e-10;      ///< greatest |residual| of a solution, as part of |y| or of 0.001 typical
  int maximum_iterations = 100;  ///< a loop that needs more has no solution near the guess
  std::vector<double> typical;   ///< usual sizes of y, one an unknown, for difference quotients; empty: 1
};

enum class NewtonStatus : uint8_t {
  converged,
  too_many_iterations,
  no_solution_found,  ///< the residual cannot be made smaller from here
  singular_jacobian,  ///< the equations do not determine the unknowns
  non_finite,         ///< a residual became infinite or not a number
  block_fault         ///< a block refused to be evaluated
};
std::string_view to_text(NewtonStatus status);

struct NewtonResult {
  NewtonStatus status = NewtonStatus::converged;
  int iterations = 0;
  int evaluations = 0;         ///< of the residual, those for Jacobians too
  double residual_norm = 0.0;  ///< greatest |residual| at the best y found, scaled as the tolerance is
  int worst_unknown = -1;      ///< where it stands
};

/// KINSOL's Newton method with line search and a dense Jacobian by differences. After construction nothing of
/// its own allocates, throws or formats.
class NewtonSolver {
 public:
  /// Throws std::invalid_argument if the options or the system make no sense.
  NewtonSolver(const NewtonOptions& options, const AlgebraicSystem& system);
  NewtonSolver(NewtonSolver&&) noexcept;
  NewtonSolver& operator=(NewtonSolver&&) noexcept;
  ~NewtonSolver();

  /// y: the guess, best the last solution; becomes the solution. Left as it was unless converged.
  NewtonResult solve(std::span<double> y);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace loopwright
