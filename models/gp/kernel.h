/// Covariance functions of two inputs, in practice position and velocity: sums of products.
///
///   k(a, b) = Σ_t σ_t² c_t0(a₀ - b₀) c_t1(a₁ - b₁),   with white noise of deviation σ_n on every observation
///
/// Products of sums are again sums of products, so this form covers every kernel built from these shapes.
/// Rasmussen, Williams, Gaussian Processes for Machine Learning, 2006, chapters 2, 4 and 5.
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

namespace loopwright::gp {

using Point = std::array<double, 2>;

inline double square(double x) { return x * x; }

/// How the covariance decreases with the distance r along one input.
struct Shape {
  enum class Kind {
    constant,             ///< 1: the term does not depend on this input
    squared_exponential,  ///< exp(-r²/(2ℓ²))
    periodic              ///< exp(-2 sin²(πr/τ)/ℓ²)
  };
  Kind kind = Kind::constant;
  double length = 1;  ///< ℓ, in the unit of the input; dimensionless for periodic
  double period = 0;  ///< τ, in the unit of the input; periodic kind only
  bool operator==(const Shape&) const = default;
};
constexpr auto names_of(Shape::Kind) {
  return std::array<std::string_view, 3>{"constant", "squared_exponential", "periodic"};
}

struct Term {
  double deviation = 1;  ///< σ_t, in the unit of the labels
  std::array<Shape, 2> along;
  bool operator==(const Term&) const = default;
};

struct Kernel {
  std::vector<Term> terms;
  double noise = 1;  ///< σ_n, in the unit of the labels
  bool operator==(const Kernel&) const = default;
};

/// c(r), from 0 to 1.
double correlation(const Shape& shape, double distance);
/// ∂c/∂(log ℓ).
double length_slope(const Shape& shape, double distance);
/// dc/dr.
double distance_slope(const Shape& shape, double distance);
/// √((-1)ⁿ c⁽²ⁿ⁾(0)): bounds the n-th derivative of every function of norm 1 in the kernel's Hilbert space.
double derivative_bound(const Shape& shape, int order);

double covariance(const Term& term, const Point& a, const Point& b);
/// Covariance without noise.
double covariance(const Kernel& kernel, const Point& a, const Point& b);
/// k(a, a) = Σ σ_t².
double prior_variance(const Kernel& kernel);

/// The hyper-parameters in the order used everywhere: for each term its deviation, then its lengths; noise
/// last. All are positive. All derivatives in this folder are with respect to their logarithms.
std::vector<double> parameters_of(const Kernel& kernel);
Kernel with_parameters(Kernel kernel, std::span<const double> parameters);
/// "terms.0.deviation", "terms.0.position.length", …, "noise".
std::vector<std::string> parameter_names(const Kernel& kernel);

/// The observations. For regression the labels have zero mean: the caller subtracts the mean and adds it
/// again.
struct Samples {
  std::vector<Point> inputs;
  std::vector<double> labels;
};

/// A function of both inputs at one point: f, ∂f/∂x, ∂f/∂v, ∂²f/∂x∂v.
using Jet = std::array<double, 4>;

/// log p(labels | inputs, kernel), and its derivatives with respect to the logarithms of the
/// hyper-parameters.
struct Evidence {
  double value = 0;
  std::vector<double> gradient;
};

}  // namespace loopwright::gp
