/// Cubic splines with two continuous derivatives.
#pragma once
#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace loopwright {

/// "periodic": slope and bend at the last point are those at the first. "at_rest": the slope is 0. "natural":
/// the bend is 0. "not_a_knot": the first two pieces are one cubic, and so are the last two, so that nothing
/// is said about the ends; fewer than four points are too few for that, and have natural ends.
enum class SplineEnds { periodic, at_rest, natural, not_a_knot };
constexpr auto names_of(SplineEnds) {
  return std::array<std::string_view, 4>{"periodic", "at_rest", "natural", "not_a_knot"};
}

struct SplinePoint {
  double value = 0, slope = 0, bend = 0;  ///< the function and its first two derivatives
};

/// Over an interval: mean + change · (x - middle) / length.
struct MeanLine {
  double mean = 0, change = 0;
};

/// A cubic over an interval that begins at x = 0, by its values and slopes at both ends.
struct CubicPiece {
  double length, first, last, first_slope, last_slope;

  /// Outside the interval it is continued.
  SplinePoint at(double x) const {
    const double chord = (last - first) / length;
    const double c = (3 * chord - 2 * first_slope - last_slope) / length,
                 d = (first_slope + last_slope - 2 * chord) / (length * length);
    return {first + x * (first_slope + x * (c + x * d)), first_slope + x * (2 * c + 3 * x * d),
            2 * c + 6 * x * d};
  }
  CubicPiece part(double from, double to) const {
    const SplinePoint begin = at(from), end = at(to);
    return {to - from, begin.value, end.value, begin.slope, end.slope};
  }
  /// The line with the same mean and the same first moment about the middle. A mass that a force moves gets
  /// by both to the same place with the same velocity.
  MeanLine line() const {
    const double change = last - first;
    return {(first + last) / 2 + length * (first_slope - last_slope) / 12,
            change + (change - length * (first_slope + last_slope) / 2) / 5};
  }
};

/// Through points of rising x, at least two.
class CubicSpline {
 public:
  CubicSpline() = default;
  CubicSpline(std::vector<double> x, std::vector<double> y, SplineEnds ends)
      : x_(std::move(x)), y_(std::move(y)), slope_(x_.size(), 0.0) {
    if (ends == SplineEnds::periodic)
      find_periodic_slopes();
    else
      find_slopes(ends);
  }
  /// Outside the points the first or last piece is continued.
  SplinePoint at(double x) const {
    const auto above = std::upper_bound(x_.begin() + 1, x_.end() - 1, x);
    const size_t i = size_t(above - x_.begin()) - 1;
    return CubicPiece{width(i), y_[i], y_[i + 1], slope_[i], slope_[i + 1]}.at(x - x_[i]);
  }
  /// At the points.
  const std::vector<double>& slopes() const { return slope_; }

 private:
  double width(size_t i) const { return x_[i + 1] - x_[i]; }
  double chord(size_t i) const { return (y_[i + 1] - y_[i]) / width(i); }

  /// Rows (lower, diagonal, upper | right) of a tridiagonal system; the solution takes the place of `right`.
  static void solve(std::vector<double> lower, std::vector<double> diagonal, const std::vector<double>& upper,
                    std::vector<double>& right) {
    const size_t n = diagonal.size();
    for (size_t i = 1; i < n; ++i) {
      const double factor = lower[i] / diagonal[i - 1];
      diagonal[i] -= factor * upper[i - 1], right[i] -= factor * right[i - 1];
    }
    for (size_t i = n; i-- > 0;)
      right[i] = (right[i] - (i + 1 < n ? upper[i] * right[i + 1] : 0)) / diagonal[i];
  }
  /// The bend is continuous at point i: h[i] s[i-1] + 2 (h[i-1] + h[i]) s[i] + h[i-1] s[i+1] = 3 (…).
  double right_side(size_t before, size_t after) const {
    return 3 * (width(after) * chord(before) + width(before) * chord(after));
  }
  /// The pieces at an end and next to it are one cubic: at the end, with g and h for their widths,
  /// h s + (g + h) s' = ((3 g + 2 h) h chord + g² chord') / (g + h).
  double of_one_cubic(size_t outer, size_t inner) const {
    const double g = width(outer), h = width(inner);
    return ((3 * g + 2 * h) * h * chord(outer) + g * g * chord(inner)) / (g + h);
  }
  void find_slopes(SplineEnds ends) {
    const size_t n = x_.size();
    std::vector<double> lower(n, 0.0), diagonal(n, 1.0), upper(n, 0.0);
    for (size_t i = 1; i + 1 < n; ++i) {
      lower[i] = width(i), diagonal[i] = 2 * (width(i - 1) + width(i)), upper[i] = width(i - 1);
      slope_[i] = right_side(i - 1, i);
    }
    if (ends == SplineEnds::not_a_knot && n > 3) {
      diagonal[0] = width(1), upper[0] = width(0) + width(1), slope_[0] = of_one_cubic(0, 1);
      diagonal[n - 1] = width(n - 3), lower[n - 1] = width(n - 2) + width(n - 3);
      slope_[n - 1] = of_one_cubic(n - 2, n - 3);
    } else if (ends != SplineEnds::at_rest) {
      diagonal[0] = diagonal[n - 1] = 2, upper[0] = lower[n - 1] = 1;
      slope_[0] = 3 * chord(0), slope_[n - 1] = 3 * chord(n - 2);
    }
    solve(lower, diagonal, upper, slope_);
  }
  /// Unknowns are the slopes at all points but the last. The two corners of the cyclic matrix are a matrix of
  /// rank one, whose share is taken out (Sherman and Morrison).
  void find_periodic_slopes() {
    const size_t n = x_.size() - 1;
    if (n == 1) {
      slope_.assign(2, chord(0));
      return;
    }
    std::vector<double> lower(n), diagonal(n), upper(n), right(n), corner(n, 0.0);
    for (size_t i = 0; i < n; ++i) {
      const size_t before = i == 0 ? n - 1 : i - 1;
      lower[i] = width(i), diagonal[i] = 2 * (width(before) + width(i)), upper[i] = width(before);
      right[i] = right_side(before, i);
    }
    if (n == 2) {  // each point has the other one on both sides
      const double determinant = diagonal[0] * diagonal[1] - (lower[0] + upper[0]) * (lower[1] + upper[1]);
      slope_[0] = (right[0] * diagonal[1] - (lower[0] + upper[0]) * right[1]) / determinant;
      slope_[1] = (right[1] * diagonal[0] - (lower[1] + upper[1]) * right[0]) / determinant;
      slope_[2] = slope_[0];
      return;
    }
    const double gamma = -diagonal[0], first = lower[0], last = upper[n - 1];
    diagonal[0] -= gamma, diagonal[n - 1] -= first * last / gamma;
    corner[0] = gamma, corner[n - 1] = last;
    solve(lower, diagonal, upper, right);
    solve(lower, diagonal, upper, corner);
    const double share =
        (right[0] + first * right[n - 1] / gamma) / (1 + corner[0] + first * corner[n - 1] / gamma);
    for (size_t i = 0; i < n; ++i) slope_[i] = right[i] - share * corner[i];
    slope_[n] = slope_[0];
  }

  std::vector<double> x_, y_, slope_;
};

}  // namespace loopwright
