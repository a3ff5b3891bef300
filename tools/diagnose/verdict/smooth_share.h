/// How much of a signal a smooth function of a variable predicts.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace loopwright::diagnosis {

/// Share of the mean square of a signal that a function of a variable, straight between this many levels,
/// explains in blocks of rows to which it was not fitted; 0 where it predicts worse than nothing. `side`
/// splits it into two functions by its sign; may be empty.
double smooth_share(std::span<const double> signal, std::span<const double> variable, size_t levels,
                    size_t block, std::span<const double> side = {});

}  // namespace loopwright::diagnosis
