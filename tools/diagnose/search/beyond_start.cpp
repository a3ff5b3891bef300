#include "tools/diagnose/search/beyond_start.h"
#include <cmath>
#include <limits>

namespace loopwright::diagnosis {

double objective_beyond_start(SiteFitter& fitter, SiteHypothesis hypothesis) {
  SitePass pass;
  if (!fitter.pass(hypothesis, false, pass)) return std::numeric_limits<double>::infinity();
  const std::vector<bool> settles = fitter.model().record().settling_rows();
  double sum = 0;
  for (size_t k = 0; k < pass.rows; ++k) {
    if (settles[k]) continue;
    for (size_t i = k * pass.outputs; i < (k + 1) * pass.outputs; ++i)
      if (!std::isnan(pass.error[i]))
        sum += std::log(pass.variance[i]) + squared(pass.error[i]) / pass.variance[i];
  }
  return sum;
}

}  // namespace loopwright::diagnosis
