/// What a model must save in twice its negative log-likelihood to be preferred.
#pragma once
#include <cmath>
#include <cstddef>

namespace loopwright {

/// Extended Bayesian information criterion: p ln n + 2 γ k ln m for p parameters, of k terms chosen among m,
/// on n numbers, with γ = 1. Chen and Chen, Biometrika 95 (2008) 759.
inline double extended_bayesian_price(size_t parameters, size_t terms, double numbers, size_t choices) {
  return double(parameters) * std::log(numbers) + 2 * double(terms) * std::log(double(choices));
}

}  // namespace loopwright
