/// Functions of one input in which a kernel along that input is a small matrix, for any number of samples.
///
/// - A periodic kernel of known period is a Fourier series whose coefficients are scaled modified Bessel
///   functions: exp(-2 sin²(πr/τ)/ℓ²) = w₀ + Σ w_j cos(2πjr/τ), w_j = 2 e^(-z) I_j(z), z = 1/ℓ².
/// - A smooth kernel on an interval is its interpolant on Chebyshev nodes, accurate to rounding with enough
///   nodes.
/// - Over few distinct values any kernel is a matrix over these values.
#pragma once
#include <span>
#include <vector>
#include "models/gp/kernel.h"

namespace loopwright::gp {

struct Basis {
  enum class Kind { constant, fourier, chebyshev, levels };
  Kind kind = Kind::constant;
  int size = 1;                ///< number of functions; odd for Fourier: 1, cos θ, sin θ, cos 2θ, …
  double period = 0;           ///< Fourier
  double low = 0, high = 0;    ///< Chebyshev: the interval; otherwise the range of the samples
  std::vector<double> levels;  ///< the distinct values, ascending
  bool operator==(const Basis&) const = default;
};
constexpr auto names_of(Basis::Kind) {
  return std::array<std::string_view, 4>{"constant", "fourier", "chebyshev", "levels"};
}

/// The number of functions that a length scale needs for the kernel to be exact to rounding.
int size_for(const Basis& basis, double length);
/// The smaller basis that suffices for a longer length scale; never larger than the given basis.
Basis cut(const Basis& basis, double length);
/// Chebyshev nodes or levels.
std::vector<double> nodes_of(const Basis& basis);

/// w_0 … of the periodic kernel for 1, cos, sin, cos, sin, …, and ∂w/∂(log ℓ).
struct PeriodicWeights {
  std::vector<double> value, slope;
};
PeriodicWeights periodic_weights(double length, int size);

/// The product of two functions of a basis is a sum of at most two of its moment functions: cos jθ, sin jθ;
/// T_j; the indicator of a level, and last the sum of all.
int moment_count(const Basis& basis);
/// The moment functions at the given values: `values.size()` numbers for each function, one function after
/// another.
void moment_functions(const Basis& basis, std::span<const double> values, int count, double* out);

struct Pairing {
  int count = 0;
  int moment[2];
  double weight[2];
};
/// The product of functions a and b; -1 is the constant function.
Pairing pairing(const Basis& basis, int a, int b);

}  // namespace loopwright::gp
