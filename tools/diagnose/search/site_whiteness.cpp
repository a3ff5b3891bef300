#include "tools/diagnose/search/site_whiteness.h"
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {

double portmanteau_of(const SitePass& pass, size_t output, size_t rows) {
  std::vector<double> e;
  for (size_t k = 0; k < rows; ++k) {
    const size_t at = k * pass.outputs + output;
    if (!std::isnan(pass.error[at])) e.push_back(pass.error[at] / std::sqrt(pass.variance[at]));
  }
  double square = 0, sum = 0;
  for (double x : e) square += x * x;
  for (size_t lag = 1; lag <= criteria::portmanteau_lags && lag < e.size(); ++lag) {
    double product = 0;
    for (size_t k = lag; k < e.size(); ++k) product += e[k] * e[k - lag];
    sum += product / square * product / square;
  }
  return double(e.size()) * sum;
}

double portmanteau_of(const SitePass& pass) {
  double worst = 0;
  for (size_t j = 0; j < pass.outputs; ++j) worst = std::max(worst, portmanteau_of(pass, j, pass.rows));
  return worst;
}

}  // namespace loopwright::diagnosis
