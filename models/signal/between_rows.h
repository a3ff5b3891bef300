/// What a recorded signal does between its rows.
#pragma once
#include <algorithm>
#include <array>
#include <string_view>
#include <vector>
#include "models/motion/cubic_spline.h"

namespace loopwright {

/// It keeps the value of a row until the next, goes on a straight line to it, or is smooth, as a signal that
/// an amplifier or a reconstruction filter has filtered.
enum class BetweenRows { hold, linear, band_limited };
constexpr auto names_of(BetweenRows) {
  return std::array<std::string_view, 3>{"hold", "linear", "band_limited"};
}

/// A signal that is known at rows of rising time, at least one; after the last it is held.
///
/// A band-limited one is the cubic spline through the rows (C. de Boor, A Practical Guide to Splines, 1978,
/// chapter IV). The gain of a sine of w rad a row is (sin(w/2) / (w/2))⁴ · 3 / (2 + cos w): 0.003 % too small
/// at an eighth of half the rate of the rows, 0.06 % at a quarter, 1.4 % at a half. Its ends are
/// "not_a_knot": a record that begins in motion has a bend there, which "natural" ends would deny.
class RowCurve {
 public:
  RowCurve() = default;
  RowCurve(std::vector<double> time, std::vector<double> value, BetweenRows between)
      : time_(std::move(time)), value_(std::move(value)), between_(between) {
    if (between_ == BetweenRows::band_limited && time_.size() > 1)
      slope_ = CubicSpline(time_, value_, SplineEnds::not_a_knot).slopes();
  }
  const std::vector<double>& time() const { return time_; }
  const std::vector<double>& value() const { return value_; }

  /// From a row to the next.
  CubicPiece piece(size_t row) const {
    const double first = value_[row];
    if (row + 1 == value_.size()) return {1, first, first, 0, 0};
    const double length = time_[row + 1] - time_[row], last = value_[row + 1],
                 chord = (last - first) / length;
    switch (between_) {
      case BetweenRows::hold:
        return {length, first, first, 0, 0};
      case BetweenRows::linear:
        return {length, first, last, chord, chord};
      case BetweenRows::band_limited:
        break;
    }
    return {length, first, last, slope_[row], slope_[row + 1]};
  }
  /// Before the first row its piece is continued.
  double at(double time) const {
    const auto above = std::upper_bound(time_.begin() + 1, time_.end(), time);
    const size_t row = size_t(above - time_.begin()) - 1;
    return piece(row).at(time - time_[row]).value;
  }

 private:
  std::vector<double> time_, value_;
  BetweenRows between_ = BetweenRows::hold;
  std::vector<double> slope_;  // of the spline, at the rows
};

}  // namespace loopwright
