/// Figures of a single recorded signal.
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace loopwright {

/// Of the cubic through four rows, at another one: what the value of each of the four counts. `at`: where the
/// rows lie, in any unit.
std::array<double, 4> weights_of_cubic(std::span<const double> at, size_t row,
                                       const std::array<size_t, 4>& around);

/// The median deviation of a signal from the cubic through the two rows before and the two behind each row,
/// over the faster half of the rows; per unit of independent noise. 0 for fewer than 20 rows. `at`: where the
/// rows lie, in any unit.
double roughness(std::span<const double> at, std::span<const double> value);

/// [unit of the signal] The standard deviation of normal noise that has this roughness. What the signal
/// itself changes within two rows counts as noise.
double noise_of(std::span<const double> at, std::span<const double> value);

/// Rows where the second difference has a peak that its neighbours do not have: single wrong samples. It
/// exceeds what nineteen of twenty rows have by a factor.
std::vector<size_t> outliers(std::span<const double> value, double factor = 20);

/// Number of rows after which a signal on an even grid repeats, over at least a third of the record; 0: it
/// does not repeat.
size_t rows_until_repeat(std::span<const double> value, double sample_time);

/// Height of the steps in which a signal changes: all its values lie on one grid. 0 if they do not.
double resolution_of(std::span<const double> value);

/// Rows from change to change of a signal that is held in between: 2 where every second row has a new value.
/// 1 if it follows the rows; 0 if it changes less than ten times.
size_t rows_between_changes(std::span<const double> value);

}  // namespace loopwright
