#include "tools/linearize/nyquist.h"
#include <cmath>
#include <numbers>

namespace loopwright {

NyquistCurves nyquist_curves(const LoopAnalysis& loop) {
  constexpr double largest_shown = 5;
  constexpr int arcs = 90;
  NyquistCurves curves;
  for (std::complex<double> value : loop.response) {
    if (!(std::abs(value) < largest_shown)) value = {std::nan(""), std::nan("")};
    curves.real.push_back(value.real()), curves.imaginary.push_back(value.imag());
  }
  if (!std::isfinite(loop.margins.Ms)) return curves;
  for (int i = 0; i <= arcs; ++i) {
    const double angle = 2 * std::numbers::pi * i / arcs;
    curves.circle_real.push_back(-1 + std::cos(angle) / loop.margins.Ms);
    curves.circle_imaginary.push_back(std::sin(angle) / loop.margins.Ms);
  }
  return curves;
}

}  // namespace loopwright
