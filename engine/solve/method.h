/// The integration methods that a diagram can select in "solver": {"method": …}.
#pragma once
#include <array>
#include <optional>
#include <string_view>

namespace loopwright {

enum class Method {
  euler,       ///< x + h f, fixed step
  heun,        ///< explicit trapezium, fixed step
  rk4,         ///< the classical Runge-Kutta method, fixed step
  dopri5,      ///< Dormand-Prince 5(4), variable step: the choice for sampled loops
  cvode_bdf,   ///< CVODE's backward differentiation formulas: the choice for stiff plants
  cvode_adams  ///< CVODE's Adams-Moulton formulas: smooth systems that are not stiff
};

/// Properties of a method. A mode e^(λt), Re λ < 0, is stable with a step h if h|λ| is below the limit:
/// `real` for a real λ, `any` for any angle of λ. 0 means that there is no such limit.
struct MethodFacts {
  Method method;
  std::string_view name;  ///< as written in a diagram
  bool fixed_step;        ///< the diagram gives the step; otherwise an error estimate chooses it
  int order;              ///< for a variable-order method the highest
  double real_stability_limit;
  double any_stability_limit;
};

/// Limits of the stability functions 1 + z, 1 + z + z²/2, … (Hairer & Wanner, Solving Ordinary Differential
/// Equations II, section IV.2). The stability regions of Euler's and Heun's methods only touch the imaginary
/// axis: no step is suitable for every lightly damped mode.
inline constexpr std::array<MethodFacts, 6> all_methods{{
    {Method::euler, "euler", true, 1, 2.0, 0.0},
    {Method::heun, "heun", true, 2, 2.0, 0.0},
    {Method::rk4, "rk4", true, 4, 2.7852, 2.6155},
    {Method::dopri5, "dopri5", false, 5, 3.3065, 0.0},
    {Method::cvode_bdf, "cvode-bdf", false, 5, 0.0, 0.0},
    {Method::cvode_adams, "cvode-adams", false, 12, 0.0, 0.0},
}};

constexpr const MethodFacts& facts(Method method) { return all_methods[static_cast<size_t>(method)]; }
constexpr std::string_view to_name(Method method) { return facts(method).name; }
constexpr bool is_fixed_step(Method method) { return facts(method).fixed_step; }

/// The method with this name, or nothing.
constexpr std::optional<Method> method_from_name(std::string_view name) {
  for (const MethodFacts& candidate : all_methods) {
    if (candidate.name == name) return candidate.method;
  }
  return std::nullopt;
}

}  // namespace loopwright
