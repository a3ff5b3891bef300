/// Whether errors are white.
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace loopwright {

/// Σ e(k) e(k - lag), for lags from 0.
inline std::vector<double> lagged_products_of(std::span<const double> errors, size_t lags) {
  std::vector<double> products(lags + 1);
  for (size_t k = 0; k < errors.size(); ++k)
    for (size_t lag = 0; lag <= std::min(lags, k); ++lag) products[lag] += errors[k] * errors[k - lag];
  return products;
}

/// n Σ ρ² over the lags from 1, with ρ the lagged products over that of lag 0; as large as their number when
/// the errors are white, with a standard deviation of √2 times its root. Box and Pierce, JASA 65 (1970) 1509.
inline double portmanteau(std::span<const double> lagged_products, double count) {
  double sum = 0;
  for (size_t lag = 1; lag < lagged_products.size(); ++lag)
    sum += lagged_products[lag] * lagged_products[lag];
  const double square = lagged_products.empty() ? 0 : lagged_products[0];
  return square > 0 ? count * sum / (square * square) : 0;
}

}  // namespace loopwright
