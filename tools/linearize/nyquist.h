/// The Nyquist curve of a loop gain where it says something about margins.
#pragma once
#include <vector>
#include "tools/linearize/analysis.h"

namespace loopwright {

struct NyquistCurves {
  std::vector<double> real, imaginary;                ///< L(jω); NaN where |L| is 5 or more
  std::vector<double> circle_real, circle_imaginary;  ///< around -1, of radius 1/Ms: the curve touches it
};

/// Far from -1 the curve says nothing about margins, and would make what does a dot.
NyquistCurves nyquist_curves(const LoopAnalysis& loop);

}  // namespace loopwright
