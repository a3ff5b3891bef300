/// One term of a posterior at a point: its correlations with the functions of its bases.
#pragma once
#include <array>
#include <vector>
#include "models/gp/kernel.h"

namespace loopwright::gp {

/// One term of a posterior: the mean is σ_t² Σ β_ab c_a(x) c_b(v) over the functions of its bases.
struct TermFeatures {
  double variance = 1;  ///< σ_t²
  std::array<Shape, 2> along;
  std::array<std::vector<double>, 2> nodes;    ///< of squared exponentials
  std::array<std::vector<double>, 2> weights;  ///< of Fourier series
  std::vector<double> coefficients;            ///< β: the weight of each function
  double norm = 0;                             ///< ‖f_t‖ σ_t, see derivative_bound()
  size_t size(size_t input) const;
};

/// Correlations of a point with the functions of a term's basis along one input: `term.size(input)` numbers.
void correlations(const TermFeatures& term, size_t input, double value, double* out);
/// Their derivatives with respect to the value.
void correlation_slopes(const TermFeatures& term, size_t input, double value, double* out);

/// Value and derivatives of the term's mean.
Jet jet_of(const TermFeatures& term, const Point& at);

}  // namespace loopwright::gp
