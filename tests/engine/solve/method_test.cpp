#include "engine/solve/method.h"

#include <gtest/gtest.h>

#include <complex>

namespace loopwright::method_test {
namespace {

TEST(Method, NamesAreReadBackAsWritten) {
  for (const MethodFacts& facts_of_one : all_methods) {
    EXPECT_EQ(method_from_name(facts_of_one.name), facts_of_one.method);
    EXPECT_EQ(to_name(facts_of_one.method), facts_of_one.name);
  }
  EXPECT_EQ(method_from_name("cvode-bdf"), Method::cvode_bdf);
  EXPECT_EQ(method_from_name("ode45"), std::nullopt);
}

TEST(Method, EulerHeunAndRk4HaveAFixedStep) {
  for (const MethodFacts& facts_of_one : all_methods) {
    EXPECT_EQ(is_fixed_step(facts_of_one.method),
              facts_of_one.order == 1 || facts_of_one.name == "heun" || facts_of_one.name == "rk4");
  }
}

/// One step of a Runge-Kutta method on x' = λ x, z = hλ, gives the truncated exponential series.
std::complex<double> growth(Method method, std::complex<double> z) {
  std::complex<double> term = 1.0, sum = 1.0;
  for (int k = 1; k <= facts(method).order; ++k) sum += term *= z / static_cast<double>(k);
  return method == Method::dopri5 ? sum + term * z / 5.0 : sum;  // its seven stages add z⁶ / 600
}

TEST(Method, StabilityLimitsAreThoseOfTheStabilityFunctions) {
  for (const Method method : {Method::euler, Method::heun, Method::rk4, Method::dopri5}) {
    const double limit = facts(method).real_stability_limit;
    EXPECT_LE(std::abs(growth(method, -limit)), 1.0) << to_name(method);
    EXPECT_GT(std::abs(growth(method, -limit * 1.001)), 1.0) << to_name(method);
    const double any = facts(method).any_stability_limit;
    for (int degrees = 90; degrees <= 180 && any > 0.0; ++degrees) {
      EXPECT_LE(std::abs(growth(method, std::polar(any, degrees * 3.14159265358979 / 180.0))), 1.0 + 1e-12)
          << degrees;
    }
  }
  EXPECT_GT(std::abs(growth(Method::heun, {0.0, 0.1})), 1.0) << "no disc for Heun's method";
}

}  // namespace
}  // namespace loopwright::method_test
