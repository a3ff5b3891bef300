/// Single readings of a sensor that do not belong to their rows.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace loopwright {

/// Rows whose reading is that of the row before although the signal moves on and has caught up in the next
/// row, and single rows that leap out and back. Ascending. A step of one count is no proof: four are.
std::vector<size_t> false_readings(std::span<const double> value);

/// Single rows far out of line whose neighbours on both sides are in line: the second differences there are
/// half as large, and of the other sign. They exceed what nineteen of twenty rows have by a factor. A sensor
/// read falsely; a command may well do so. Ascending.
std::vector<size_t> leaps_out_and_back(std::span<const double> value, double factor = 20);

/// Single rows of zero among others of one sign beyond the noise: a device that was not ready. Ascending.
std::vector<size_t> single_zeros(std::span<const double> value);

/// Which single values of a recorded input the machine does not feel: none; those far out of line; or also
/// those nearer, and zeros.
enum class InputLeaps { felt, far_unfelt, unfelt };
/// Rows of the values that are not felt. Ascending.
std::vector<size_t> unfelt_rows(std::span<const double> input, InputLeaps leaps);

/// The readings of these rows become those of the cubic through the two nearest other rows on either side.
/// `at`: where the rows lie, in any unit. Rows without two on either side keep theirs.
void replace_readings(std::span<const double> at, std::span<double> value, std::span<const size_t> rows);

}  // namespace loopwright
