/// Functions of one input in which a kernel along that input is a small matrix, however many samples there
/// are.
///
/// - A periodic kernel of known period is a Fourier series whose coefficients are scaled modified Bessel
///   functions: exp(-2 sin²(πr/τ)/ℓ²) = w₀ + Σ w_j cos(2πjr/τ), w_j = 2 e^(-z) I_j(z), z = 1/ℓ².
/// - A smooth kernel on an interval is its interpolant on Chebyshev nodes, to rounding when there are enough.
/// - Over few distinct values any kernel is a matrix of its values.
#pragma once
#include <span>
#include <vector>
#include "models/gp/kernel.h"

namespace loopwright::gp {

struct Basis {
  enum class Kind { constant, fourier, chebyshev, levels };
  Kind kind = Kind::constant;
  int size = 1;                ///< functions; of a Fourier basis odd: 1, cos θ, sin θ, cos 2θ, …
  double period = 0;           ///< Fourier
  double low = 0, high = 0;    ///< Chebyshev: the interval; the others: range of the samples
  std::vector<double> levels;  ///< the distinct values, rising
  bool operator==(const Basis&) const = default;
};
constexpr auto names_of(Basis::Kind) {
  return std::array<std::string_view, 4>{"constant", "fourier", "chebyshev", "levels"};
}

/// How many functions a length scale needs for the kernel to be exact to rounding.
int size_for(const Basis& basis, double length);
/// The smaller basis that a longer length scale gets by with; never larger than the basis itself.
Basis cut(const Basis& basis, double length);
/// Chebyshev nodes or levels.
std::vector<double> nodes_of(const Basis& basis);

/// w_0 … of the periodic kernel, for 1, cos, sin, cos, sin, …, and ∂w/∂(log ℓ).
struct PeriodicWeights {
  std::vector<double> value, slope;
};
PeriodicWeights periodic_weights(double length, int size);

/// Products of two functions of a basis are sums of at most two of its moment functions: cos j θ, sin jθ;
/// T_j; the indicator of a level, and last the sum of all.
int moment_count(const Basis& basis);
/// The moment functions at values, `values.size()` numbers for each function in turn.
void moment_functions(const Basis& basis, std::span<const double> values, int count, double* out);

struct Pairing {
  int count = 0;
  int moment[2];
  double weight[2];
};
/// Of functions a and b; -1 stands for the constant function.
Pairing pairing(const Basis& basis, int a, int b);

}  // namespace loopwright::gp
