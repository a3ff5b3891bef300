// Systems for the tests of the solvers, written as lambdas, and a record of their evaluations.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "engine/solve/solver.h"

namespace loopwright::testing {

/// An OdeSystem from two functions. Stores the earliest and latest time at which it was evaluated.
struct FunctionSystem {
  using Function = std::function<bool(double t, const double* x, double* result)>;

  int states = 0;
  Function derivatives;
  int crossings = 0;
  Function crossing_values = {};
  int64_t evaluations = 0;
  double earliest = std::numeric_limits<double>::infinity();
  double latest = -std::numeric_limits<double>::infinity();

  OdeSystem ode() {
    return {this, states, crossings,
            [](void* self, double t, const double* x, double* rate) {
              auto& system = *static_cast<FunctionSystem*>(self);
              ++system.evaluations;
              return system.note(t).derivatives(t, x, rate);
            },
            [](void* self, double t, const double* x, double* value) {
              return static_cast<FunctionSystem*>(self)->note(t).crossing_values(t, x, value);
            }};
  }
  FunctionSystem& note(double t) {
    earliest = std::min(earliest, t);
    latest = std::max(latest, t);
    return *this;
  }
};

/// x'' = -ω² x
inline FunctionSystem oscillator(double omega) {
  return {.states = 2, .derivatives = [omega](double, const double* x, double* rate) {
            rate[0] = x[1];
            rate[1] = -omega * omega * x[0];
            return true;
          }};
}

/// x' = λ x
inline FunctionSystem exponential(double lambda) {
  return {.states = 1, .derivatives = [lambda](double, const double* x, double* rate) {
            rate[0] = lambda * x[0];
            return true;
          }};
}

/// Constant states: only time advances.
inline FunctionSystem clock_with(int crossings, FunctionSystem::Function values) {
  return {.states = 1,
          .derivatives = [](double, const double*, double* rate) { return rate[0] = 1.0, true; },
          .crossings = crossings,
          .crossing_values = std::move(values)};
}

inline SolverOptions tolerances(Method method, double relative, double absolute) {
  SolverOptions options;
  options.method = method;
  options.relative_tolerance = relative;
  options.absolute_tolerance = absolute;
  return options;
}

constexpr Method variable_step_methods[] = {Method::dopri5, Method::cvode_bdf, Method::cvode_adams};

/// "dopri5", "cvode_bdf": names as gtest requires.
inline std::string test_name(const ::testing::TestParamInfo<Method>& parameter) {
  std::string name(to_name(parameter.param));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

}  // namespace loopwright::testing
