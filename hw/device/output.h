/// What a device puts out for a commanded value. Deployment and replay both use it.
#pragma once
#include <algorithm>
#include "hw/device/description.h"

namespace loopwright::hw {

struct LimitedOutput {
  double value = 0;
  bool is_clamped = false, is_rate_limited = false;
};

/// The finite value within the limits of the output, and not farther from the value before than its maximum
/// rate allows in a period.
inline LimitedOutput limited(const OutputChannel& output, double wanted, double before,
                             double period_s) noexcept {
  LimitedOutput result{std::clamp(wanted, output.least(), output.greatest())};
  result.is_clamped = result.value != wanted;
  if (const double step = output.maximum_rate * period_s; step > 0) {
    const double near = std::clamp(result.value, before - step, before + step);
    result.is_rate_limited = near != result.value;
    result.value = near;
  }
  return result;
}

}  // namespace loopwright::hw
