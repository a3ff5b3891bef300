#include "tools/diagnose/predict/front.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace loopwright::diagnosis {
namespace {

/// [widths] Beyond it the hyperbolic tangent is constant within a thousandth.
constexpr double reach = 4;
/// [widths] Parts in which a step goes through it.
constexpr double part = 2;
constexpr double never = std::numeric_limits<double>::infinity();

/// The first u > 0 at which a + b u + c u² = 0, for a > 0.
double first_zero(double a, double b, double c) {
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return never;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
  double first = never;
  for (const double u : {q / c, a / q})
    if (u > 0) first = std::min(first, u);
  return first;
}

}  // namespace

double Front::longest_step() const {
  const double through = first_zero(part * width_, -std::abs(slope_), -std::abs(curvature_));
  const double outside = std::abs(begin_) - reach * width_;
  if (outside <= 0) return through;
  const double side = begin_ < 0 ? -1 : 1;
  return std::max(through, first_zero(outside, side * slope_, side * curvature_));
}

}  // namespace loopwright::diagnosis
