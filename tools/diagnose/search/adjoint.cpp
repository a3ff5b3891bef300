#include "tools/diagnose/search/adjoint.h"
#include "tools/diagnose/search/backward.h"

namespace loopwright::diagnosis {

std::vector<double> adjoint(const Trial& trial, const Fitted& fitted, Acts acts) {
  const ErrorSystem system(fitted, acts == Acts::input);
  std::vector<double> weight(fitted.prediction.path.samples());
  run_backward(
      system, fitted, [&](size_t k) { return trial.usable[k] && k < trial.held_out_from; },
      [&](size_t k, const auto& after, const auto&, const auto& sensed, const auto& through) {
        weight[k] = acts == Acts::sensor ? sensed[0] - through[0] : -system.enter.dot(after);
      });
  return weight;
}

}  // namespace loopwright::diagnosis
