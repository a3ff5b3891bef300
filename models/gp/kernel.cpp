#include "models/gp/kernel.h"
#include <cmath>
#include <numbers>
#include "models/gp/basis.h"
#include "models/real/double_functions.h"

namespace loopwright::gp {
namespace {

/// -log c, which is 2 sin²(πr/τ)/ℓ² or r²/(2ℓ²).
double exponent(const Shape& shape, double r) {
  switch (shape.kind) {
    case Shape::Kind::constant:
      return 0;
    case Shape::Kind::squared_exponential:
      return 0.5 * square(r / shape.length);
    case Shape::Kind::periodic: {
      const double turns = r / shape.period;
      return 2 * square(sine(std::numbers::pi * (turns - std::nearbyint(turns))) / shape.length);
    }
  }
  return 0;
}

/// Calls f(hyper-parameter, name) in the order of parameters_of().
template <class AnyKernel, class F> void for_each_parameter(AnyKernel& kernel, F&& f) {
  static const char* const inputs[] = {"position", "velocity"};
  for (size_t t = 0; t < kernel.terms.size(); ++t) {
    const std::string term = "terms." + std::to_string(t) + ".";
    f(kernel.terms[t].deviation, term + "deviation");
    for (size_t d = 0; d < 2; ++d)
      if (kernel.terms[t].along[d].kind != Shape::Kind::constant)
        f(kernel.terms[t].along[d].length, term + inputs[d] + ".length");
  }
  f(kernel.noise, "noise");
}

}  // namespace

double correlation(const Shape& shape, double r) { return exponential(-exponent(shape, r)); }

double length_slope(const Shape& shape, double r) {
  const double e = exponent(shape, r);
  return 2 * e * exponential(-e);
}

double distance_slope(const Shape& shape, double r) {
  switch (shape.kind) {
    case Shape::Kind::constant:
      return 0;
    case Shape::Kind::squared_exponential:
      return -r / square(shape.length) * correlation(shape, r);
    case Shape::Kind::periodic: {
      // d/dr 2 sin²(πr/τ)/ℓ² = 2π sin(2πr/τ)/(τℓ²)
      const double turns = r / shape.period;
      return -2 * std::numbers::pi * sine(2 * std::numbers::pi * (turns - std::nearbyint(turns))) /
             (shape.period * square(shape.length)) * correlation(shape, r);
    }
  }
  return 0;
}

double derivative_bound(const Shape& shape, int order) {
  switch (shape.kind) {
    case Shape::Kind::constant:
      return order == 0 ? 1 : 0;
    case Shape::Kind::squared_exponential: {  // (2n - 1)!!/ℓ²ⁿ
      double product = 1;
      for (int i = 1; i <= order; ++i) product *= (2 * i - 1) / square(shape.length);
      return std::sqrt(product);
    }
    case Shape::Kind::periodic: {  // Σ w_j (2πj/τ)²ⁿ
      const std::vector<double> weights =
          periodic_weights(shape.length, size_for({Basis::Kind::fourier}, shape.length)).value;
      double sum = order == 0 ? weights[0] : 0;
      for (size_t i = 1; i < weights.size(); i += 2)
        sum += weights[i] * any_power(2 * std::numbers::pi * double((i + 1) / 2) / shape.period, 2 * order);
      return std::sqrt(sum);
    }
  }
  return 0;
}

double covariance(const Term& term, const Point& a, const Point& b) {
  return square(term.deviation) *
         exponential(-exponent(term.along[0], a[0] - b[0]) - exponent(term.along[1], a[1] - b[1]));
}

double covariance(const Kernel& kernel, const Point& a, const Point& b) {
  double sum = 0;
  for (const Term& term : kernel.terms) sum += covariance(term, a, b);
  return sum;
}

double prior_variance(const Kernel& kernel) {
  double sum = 0;
  for (const Term& term : kernel.terms) sum += square(term.deviation);
  return sum;
}

std::vector<double> parameters_of(const Kernel& kernel) {
  std::vector<double> values;
  for_each_parameter(kernel, [&](double value, const std::string&) { values.push_back(value); });
  return values;
}

Kernel with_parameters(Kernel kernel, std::span<const double> parameters) {
  size_t i = 0;
  for_each_parameter(kernel, [&](double& value, const std::string&) { value = parameters[i++]; });
  return kernel;
}

std::vector<std::string> parameter_names(const Kernel& kernel) {
  std::vector<std::string> names;
  for_each_parameter(kernel, [&](double, const std::string& name) { names.push_back(name); });
  return names;
}

}  // namespace loopwright::gp
