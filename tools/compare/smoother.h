/// Functions of one variable fitted to a residual, evaluated on held-out blocks of the record.
#pragma once
#include "tools/compare/missing_force.h"

namespace loopwright {

/// Rows of a record thinned until they are independent after the low-pass filter, in blocks of about a
/// second.
struct Rows {
  std::vector<size_t> index;  ///< in the record
  std::vector<double> residual, position, velocity, acceleration, time;
  std::vector<int> block;  ///< block of time of each row
  int blocks = 0;
};

Rows thinned(const MeasuredMotion& motion, const std::vector<double>& residual);

/// By hat functions of the variable, eight-fold cross-validated.
Dependence explained_by(const Rows& rows, std::string name, const std::vector<double>& variable);

/// By the strongest sine of the variable: found on every other block, evaluated on the rest.
Dependence strongest_line(const Rows& rows, std::string name, const std::vector<double>& variable);

/// rms of the remainder after a large set of smooth functions and the strongest spatial lines, corrected for
/// their number.
double floor_of_smooth_parts(const Rows& rows);

}  // namespace loopwright
