/// How time stamps are written.
#pragma once
#include <span>

namespace loopwright {

/// [s] The last decimal digit with which the times are written; 0: they have more than nine.
double last_digit(std::span<const double> times);

}  // namespace loopwright
