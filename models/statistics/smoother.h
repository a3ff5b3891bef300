/// How much of a signal a smooth function of a variable predicts.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace loopwright {

/// Functions that are straight between knots, as sums of hats: one at each knot, zero at the others.
class Hats {
 public:
  /// Knots at equal distances over the range of the values.
  static Hats at_equal_distances(std::span<const double> values, size_t knots);
  /// Knots with as many values between each two of them; fewer where values repeat.
  static Hats between_quantiles(std::span<const double> values, size_t knots);

  size_t count() const { return knots_.size(); }
  /// A value between two knots: the lower one, and the weight of the other, 0 … 1. Beyond the ends it counts
  /// as the last knot.
  struct Place {
    size_t knot = 0;
    double weight = 0;
  };
  Place at(double value) const;

 private:
  std::vector<double> knots_;
};

/// Least squares of a signal in some folds of its rows, judged in the others.
struct CrossValidation {
  std::vector<Hats::Place> places;  ///< of each row, among `columns` hats
  size_t columns = 0;               ///< several functions have theirs one after the other
  std::vector<size_t> fold;         ///< of each row
  size_t folds = 0;

  /// 1 - Σ left² / Σ signal²; negative where it predicts worse than zero does, 0 for a signal of zeros.
  double share_of(std::span<const double> signal) const;
};

}  // namespace loopwright
