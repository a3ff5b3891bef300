#include "tools/diagnose/predict/affine_sample.h"
#include <utility>

namespace loopwright::diagnosis {

AffineSample::AffineSample(std::vector<int> states, const Step& step)
    : states_(std::move(states)), coefficients_(states_.size() * (states_.size() + 3)) {
  const size_t n = states_.size(), width = n + 3;
  const auto column = [&](size_t at, std::vector<double> from, double input, double force) {
    step(from, input, force);
    for (size_t i = 0; i < n; ++i) {
      coefficients_[i * width + at] = from[i];
      if (at != n + 2) coefficients_[i * width + at] -= coefficients_[i * width + n + 2];
    }
  };
  const std::vector<double> zero(n, 0.0);
  column(n + 2, zero, 0, 0);
  column(n, zero, 1, 0), column(n + 1, zero, 0, 1);
  for (size_t j = 0; j < n; ++j) {
    std::vector<double> unit = zero;
    unit[j] = 1;
    column(j, unit, 0, 0);
  }
}

}  // namespace loopwright::diagnosis
