/// Small-gain theorem with several functions of bounded slope around one linear system.
#pragma once
#include <Eigen/Core>
#include "tools/stability/stability.h"

namespace loopwright {

/// An input of a function as a sum of ports, z = Σ weight · port: a prediction with a lead uses x + T v.
struct FunctionInput {
  std::vector<std::pair<std::string, double>> ports;
  double slope = 0;  ///< greatest |∂f/∂z|
};

/// w = f(z₁, z₂ …), added to the output port `output`.
struct BoundedFunction {
  std::string output;
  std::vector<FunctionInput> inputs;
  bool scales_with_alpha = false;
};

enum class GainOf { peak, energy };

/// N at α = 1 for the functions that scale with it: N_ik = Σ_j L_ij ‖z_ij ← w_k‖. The diagram's own slopes of
/// the functions must have been removed from `linear`, except those that belong to the linear part; `unit` is
/// the factor by which the diagram multiplies a learned function. Gains are upper bounds. Functions of
/// continuous signals may change `subdivisions` times per sample, held in between.
Eigen::MatrixXd small_gain_matrix(const LinearDiagram& linear, const std::vector<BoundedFunction>& functions,
                                  double unit, double sample_time, int subdivisions, GainOf gain);

/// Largest |eigenvalue| of a matrix of gains whose columns of `learned` are multiplied by α.
double spectral_radius(Eigen::MatrixXd gains, const std::vector<BoundedFunction>& functions, double alpha);

/// The certificate at `alpha`, and the largest α at which it holds.
Certificate certify(const Eigen::MatrixXd& gains, const std::vector<BoundedFunction>& functions,
                    double alpha);

/// Upper bound of the gain between all inputs and outputs of a system, lifted or not: peak to peak over all
/// of them, or of energy. Infinite for an unstable system.
double gain_bound(const StateSpace& system, GainOf gain);

}  // namespace loopwright
