/// A function of two variables as a picture: curves over x, one behind the other along y.
#pragma once
#include <string>
#include <vector>
#include "tools/report/report.h"

namespace loopwright::report {

/// z(x, y). Heights are given curve by curve, z[j][i] at (x[i], y[j]), with increasing y. No curves: only
/// points.
struct Waterfall {
  std::string title;
  Axis x, y, z;
  std::vector<double> x_values, y_values;
  std::vector<std::vector<double>> z_values;
  /// Points in space: drawn over the curves behind them and under the curves in front of them.
  struct Cloud {
    std::string name;
    std::vector<double> x, y, z;
    bool joined = false;  ///< as a line, drawn over everything
  };
  std::vector<Cloud> clouds;
  double z_low = 0, z_high = 0;  ///< of the axis; equal: determined by the values. For pictures side by side
  std::string caption;
};

/// The text of the picture states the ranges. Throws std::invalid_argument for inconsistent list lengths.
Picture waterfall_picture(const Waterfall& waterfall);

}  // namespace loopwright::report
