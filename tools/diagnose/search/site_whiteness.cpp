#include "tools/diagnose/search/site_whiteness.h"
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {

namespace {

/// The whitened errors of an output that was read.
std::vector<double> whitened_errors(const SitePass& pass, size_t output, size_t rows) {
  std::vector<double> e;
  for (size_t at = output; at < rows * pass.outputs; at += pass.outputs)
    if (!std::isnan(pass.error[at])) e.push_back(pass.error[at] / std::sqrt(pass.variance[at]));
  return e;
}

std::vector<double> correlations_within(const std::vector<double>& e) {
  double square = 0;
  for (double x : e) square += x * x;
  std::vector<double> list;
  for (size_t lag = 1; lag <= criteria::portmanteau_lags && lag < e.size(); ++lag) {
    double product = 0;
    for (size_t k = lag; k < e.size(); ++k) product += e[k] * e[k - lag];
    list.push_back(square > 0 ? product / square : 0);
  }
  return list;
}

}  // namespace

std::vector<double> correlations_of(const SitePass& pass, size_t output, size_t rows) {
  return correlations_within(whitened_errors(pass, output, rows));
}

double portmanteau_of(const SitePass& pass, size_t output, size_t rows) {
  const std::vector<double> e = whitened_errors(pass, output, rows);
  double sum = 0;
  for (double r : correlations_within(e)) sum += r * r;
  return double(e.size()) * sum;
}

double portmanteau_of(const SitePass& pass) {
  double worst = 0;
  for (size_t j = 0; j < pass.outputs; ++j) worst = std::max(worst, portmanteau_of(pass, j, pass.rows));
  return worst;
}

}  // namespace loopwright::diagnosis
