/// Sums that do not depend on the machine.
#pragma once
#include <Eigen/Dense>

namespace loopwright::diagnosis {

/// Eigen adds up a long product in blocks whose sizes follow from the caches of the processor, so that last
/// bits, and with them answers that hang on them, differ between machines. With these sizes [bytes], those of
/// a common server, they are the same on all.
inline const bool has_same_blocks = [] {
  constexpr std::ptrdiff_t first = 48 << 10, second = 2 << 20, third = 100 << 20;
  Eigen::setCpuCacheSizes(first, second, third);
  return true;
}();

}  // namespace loopwright::diagnosis
