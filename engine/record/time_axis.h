/// Is this column a time, and is it sampled evenly?
#pragma once
#include <cstdint>
#include <span>
#include <vector>
#include "engine/json/problem.h"
#include "engine/record/recording.h"

namespace loopwright {

struct TimeAxis {
  double start = 0;  ///< [s]
  double sample_time =
      0;  ///< [s] of the grid, else the mean step where it is near the median, else that; 0 for a single row
  bool regular =
      false;  ///< every time lies on the grid start + k · sample_time, k = 0, 1, …, within the tolerance
  bool on_grid = false;  ///< the same, but samples may be missing between rows: k = sample_numbers()
  int64_t missing = 0;   ///< samples between the first and the last row that have no row
};

struct TimeOptions {
  double tolerance = 0.01;  ///< [sample times] times are printed with few digits and stamped with jitter
  double gap = 1.5;         ///< [median steps] a longer step has lost a sample
  bool must_be_regular =
      false;               ///< integration over measured times needs no even grid; filters and delays do
  int most_problems = 20;  ///< one screenful shows what is wrong; the rest is counted
};

/// Errors: no rows, NaN or infinite times, times that do not grow (each with its row, counted from 1, and
/// time). Gaps are warnings with row and time, as is an uneven grid; both are errors with must_be_regular.
/// Where times do not grow the axis is {0, 0, false}. All problems carry `place`, such as the key that named
/// the column. A sample time that is a short decimal is given as such: 0.001, not 0.0010000000000000002.
TimeAxis check_time(const Column& time, Problems& problems, const TimeOptions& options = {},
                    const Place& place = {});

/// The sample that each row is, counted from the first row. A row whose time stamp only trembles is the next
/// sample; behind a gap, from which on all times are late by whole samples, as many are left out.
std::vector<int64_t> sample_numbers(std::span<const double> times, double sample_time);

}  // namespace loopwright
