#include "tools/diagnose/search/site_whiteness.h"
#include <algorithm>
#include <cmath>
#include "models/statistics/portmanteau.h"
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

}  // namespace

std::vector<double> correlations_of(const SitePass& pass, size_t output, size_t rows) {
  const std::vector<double> e = whitened_errors(pass, output, rows);
  std::vector<double> list = lagged_products_of(e, criteria::portmanteau_lags);
  const double square = list.front();
  list.erase(list.begin()), list.resize(std::min(list.size(), e.empty() ? 0 : e.size() - 1));
  for (double& r : list) r = square > 0 ? r / square : 0;
  return list;
}

double portmanteau_of(const SitePass& pass, size_t output, size_t rows) {
  const std::vector<double> e = whitened_errors(pass, output, rows);
  return portmanteau(lagged_products_of(e, criteria::portmanteau_lags), double(e.size()));
}

double most_error_of_counts(const RecordedOutput& output) {
  return criteria::most_error_of_counts * output.resolution / std::sqrt(12);
}

double portmanteau_beside_counts(const SitePass& pass, const SignalRecord& record) {
  const std::vector<bool> settles = record.settling_rows();
  double worst = 0;
  for (size_t j = 0; j < pass.outputs; ++j) {
    double squares = 0, count = 0;
    for (size_t row = 0; row < pass.rows; ++row)
      if (const double e = pass.error[row * pass.outputs + j]; !std::isnan(e) && !settles[row])
        squares += e * e, count += 1;
    const double most = most_error_of_counts(record.outputs[j]);
    if (!(squares < most * most * count)) worst = std::max(worst, portmanteau_of(pass, j, pass.rows));
  }
  return worst;
}

}  // namespace loopwright::diagnosis
