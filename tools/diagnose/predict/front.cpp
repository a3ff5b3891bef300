#include "tools/diagnose/predict/front.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

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
  const double through =
      first_zero(criteria::part_of_front * width_, -std::abs(slope_), -std::abs(curvature_));
  const double outside = std::abs(begin_) - criteria::reach_of_front * width_;
  if (outside <= 0) return through;
  const double side = begin_ < 0 ? -1 : 1;
  return std::max(through, first_zero(outside, side * slope_, side * curvature_));
}

}  // namespace loopwright::diagnosis
