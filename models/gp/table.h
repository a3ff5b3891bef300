/// The posterior mean as tables of cubic Hermite pieces: a few nanoseconds per prediction, with an error
/// bound that holds everywhere.
///
/// Each term of the kernel has a table over the inputs on which it depends: a period or an interval along the
/// position, an interval along the velocity. The mean f of a term lies in the Hilbert space of its kernel, so
/// |∂ᵃ∂ᵇf| ≤ ‖f‖ σ √(c₀⁽²ᵃ⁾(0) c₁⁽²ᵇ⁾(0)). The error of a cubic Hermite piece of width h is at most h⁴/384
/// max|f⁗|. Outside its interval a term is taken as zero; |f| ≤ σ² Σ|w_i| c(distance) bounds this error.
/// Steinwart, Christmann, Support Vector Machines, 2008, corollary 4.36; Davis, Interpolation and
/// Approximation, 1975, theorem 3.5.1.
#pragma once
#include "models/gp/model.h"

namespace loopwright::gp {

class MeanTable {
 public:
  /// `tolerance` in the unit of the labels; 0: a millionth of the prior deviation of the kernel.
  explicit MeanTable(const Posterior& posterior, double tolerance = 0);

  double operator()(const Point& at) const {
    double sum = constant_;
    for (const TermTable& table : tables_)
      sum += table.is_flat() ? table.along_one(at) : table.along_both(at);
    return sum;
  }
  /// Upper bound of |table - Posterior::mean| everywhere: interpolation, cut-off tails and rounding.
  double bound() const { return bound_; }
  size_t bytes() const;

 private:
  struct Axis {
    bool is_seen = false, wraps = false;
    double low = 0, high = 0, step = 1, per_step = 1;
    int cells = 1;
    /// The cell of a value and the position in it, 0 … 1; false outside the interval.
    bool find(double value, int& cell, double& place) const;
  };
  struct TermTable {
    std::array<Axis, 2> axis;
    std::vector<Jet> nodes;                     ///< two inputs: rows of velocities
    std::vector<std::array<double, 4>> pieces;  ///< one input: polynomial in the position in the cell
    bool is_flat() const { return nodes.empty(); }
    double along_one(const Point& at) const;
    double along_both(const Point& at) const;
  };
  TermTable tabulate(const Posterior& posterior, size_t term, double tolerance);

  double constant_ = 0, bound_ = 0;
  std::vector<TermTable> tables_;
};

/// Upper bounds of the slopes of the mean over the trained velocities and all positions: the largest values
/// on a grid plus the largest change between grid points according to the curvature.
struct SlopeBounds {
  double by_position = 0;  ///< label unit per m
  double by_velocity = 0;  ///< label unit per m/s
  double mean = 0;         ///< greatest |mean|, label unit
};
SlopeBounds slope_bounds(const Posterior& posterior);

}  // namespace loopwright::gp
