/// The response of a linear block to a sine, computed from its step alone, without knowledge of the expected
/// result.
#pragma once
#include <complex>
#include "tests/blocks/block_under_test.h"

namespace loopwright {

using Complex = std::complex<double>;

/// Y(jw)/U(jw) of a continuous block, w in rad/s: x' = A x + B u is determined from unit vectors and solved
/// at jw.
inline Complex continuous_response(BlockUnderTest& block, std::string_view input, std::string_view output,
                                   double w) {
  const size_t n = block.states().size();
  const auto probe = [&](size_t unit) {  // n: the input
    for (double& x : block.states()) x = 0;
    block.input(input) = unit == n ? 1 : 0;
    if (unit < n) block.states()[unit] = 1;
    block.evaluate_held(0);
    block.derivatives();
  };
  std::vector<std::vector<Complex>> rows(n, std::vector<Complex>(n + 1));
  std::vector<double> shows(n + 1);
  for (size_t column = 0; column <= n; ++column) {
    probe(column);
    shows[column] = block.output(output);
    for (size_t i = 0; i < n; ++i) rows[i][column] = column < n ? -block.rates()[i] : block.rates()[i];
  }
  for (size_t i = 0; i < n; ++i) rows[i][i] += Complex(0, w);
  for (size_t k = 0; k < n; ++k) {  // Gauss-Jordan elimination with pivoting
    size_t best = k;
    for (size_t i = k; i < n; ++i)
      if (std::abs(rows[i][k]) > std::abs(rows[best][k])) best = i;
    std::swap(rows[k], rows[best]);
    for (size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const Complex factor = rows[i][k] / rows[k][k];
      for (size_t j = k; j <= n; ++j) rows[i][j] -= factor * rows[k][j];
    }
  }
  Complex y = shows[n];
  for (size_t i = 0; i < n; ++i) y += shows[i] * rows[i][n] / rows[i][i];
  return y;
}

/// Y/U at z = e^(jwT) of a sampled block that starts at zero: the sum over its impulse response of `samples`
/// values.
inline Complex sampled_response(BlockUnderTest& block, std::string_view input, std::string_view output,
                                double w, double sample_time, int samples = 20000) {
  block.restart();
  Complex sum = 0;
  for (int k = 0; k < samples; ++k)
    sum += block.sample(input, k == 0 ? 1 : 0, output) * std::polar(1.0, -w * sample_time * k);
  return sum;
}

/// The value that Tustin's rule substitutes for s at z = e^(jwT).
inline Complex tustin(double w, double sample_time) {
  return {0.0, 2 / sample_time * std::tan(w * sample_time / 2)};
}

#define EXPECT_COMPLEX_NEAR(found, expected, tolerance)                                               \
  EXPECT_NEAR(std::abs(::loopwright::Complex(found) - ::loopwright::Complex(expected)), 0, tolerance) \
      << "found " << ::loopwright::Complex(found) << ", expected " << ::loopwright::Complex(expected)

}  // namespace loopwright
