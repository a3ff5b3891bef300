/// Checks whether a column is a time, and whether it is evenly sampled.
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
      0;  ///< [s] of the grid, else the mean step if it is near the median, else the median; 0 for one row
  bool regular =
      false;  ///< every time lies on the grid start + k · sample_time, k = 0, 1, …, within the tolerance
  bool on_grid = false;  ///< the same, but samples may be missing between rows: k = sample_numbers()
  int64_t missing = 0;   ///< samples without a row between the first and the last row
};

struct TimeOptions {
  double tolerance = 0.01;  ///< [sample times] for times with few digits and jitter
  double gap = 1.5;         ///< [median steps] a longer step has missing samples
  bool must_be_regular =
      false;               ///< integration over measured times needs no even grid; filters and delays do
  int most_problems = 20;  ///< enough for one screen; the rest is counted
};

/// Errors: no rows, NaN or infinite times, times that do not increase (each with its row, counted from 1, and
/// its time). Gaps are warnings with row and time, and so is an uneven grid; both are errors with
/// must_be_regular. If times do not increase, the axis is {0, 0, false}. All problems have the location
/// `place`, such as the key that named the column. A sample time that is a short decimal or
/// another simple fraction is returned as such: 0.001, not 0.0010000000000000002, and 1/750 for stamps that
/// were rounded to microseconds. Stamps that were only rounded lie on the grid.
TimeAxis check_time(const Column& time, Problems& problems, const TimeOptions& options = {},
                    const Place& place = {});

/// The sample number of each row, counted from the first row. A row whose time stamp only jitters is the next
/// sample. After a gap, where all times are late by an integer number of samples, this number of samples is
/// skipped.
std::vector<int64_t> sample_numbers(std::span<const double> times, double sample_time);

/// [s] The instants start + k · sample_time of rows whose stamps lie beside them by no more than their last
/// digit: the samples were even, and the clock was read coarsely. Empty where the stamps are to be used: on
/// the grid already, off it by more than their rounding, written so finely that it does not matter, or too
/// few to tell a grid from a table that was written by hand. `axis`: of these times, by check_time().
std::vector<double> unrounded(std::span<const double> times, const TimeAxis& axis);

}  // namespace loopwright
