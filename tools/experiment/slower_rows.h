/// Signals that are sampled more slowly than the rows of their file.
#pragma once
#include <span>
#include <vector>
#include "engine/record/recording.h"

namespace loopwright {

/// The rows of a signal that is sampled more slowly than the others: numbers in every so many rows, and NaN
/// in all between. `every` is 1 if its rows are not so.
struct SlowerRows {
  size_t first = 0, every = 1;
  bool are_all() const { return every == 1; }
  bool operator==(const SlowerRows&) const = default;
};
SlowerRows rows_with_numbers(std::span<const double> value);
/// The same of a column; one without holes has all rows.
SlowerRows rows_of(const Column& column);
/// Of the values of all rows those of these rows.
std::vector<double> picked(const SlowerRows& rows, const std::vector<double>& values);
/// The means of the values from each of these rows to the next.
std::vector<double> means_from(const SlowerRows& rows, const std::vector<double>& values);

}  // namespace loopwright
