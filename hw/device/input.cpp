#include "hw/device/input.h"
#include <cmath>

namespace loopwright::hw {
namespace {

// A converter may read slightly beyond its range because of offset and noise. A tenth of the range is more
// than such an error.
constexpr double beyond_range = 0.1;

// Counters of devices have 32 bits at most, read with or without a sign.
constexpr double least_counter = -2147483648.0, greatest_counter = 4294967295.0;

/// Within the range of a counter with this many bits, read with or without a sign.
bool fits(int64_t counter, int bits) {
  const int64_t range = int64_t(1) << bits;
  return counter >= -range / 2 && counter < range;
}

}  // namespace

/// A counter wider than `counter_bits` is read correctly as long as it continues from its previous value: its
/// difference is then the same at both widths. Any other number beyond the width did not come from a counter.
Input::Converted Input::unwrap(double raw) const noexcept {
  if (raw != std::nearbyint(raw)) return {Reading::not_whole};
  if (raw < least_counter || raw > greatest_counter) return {Reading::beyond_counter};
  const auto read = int64_t(raw);
  Converted to{Reading::good, 0, uint32_t(read), read, fits(read, channel_->counter_bits)};
  if (!is_known_) {
    if (!to.fits) to.reading = Reading::beyond_counter;
    return to;
  }
  const uint32_t difference = to.counter - counter_;
  const int unused = 32 - channel_->counter_bits;
  const int32_t narrow = int32_t(difference << unused) >> unused, wide = int32_t(difference);
  if (!(to.fits && has_fitted_) && narrow != wide) to.reading = Reading::beyond_counter;
  to.counts = counts_ + narrow;
  return to;
}

Input::Converted Input::convert(double raw) const noexcept {
  if (!std::isfinite(raw)) return {Reading::not_finite};
  Converted to;
  if (channel_->kind == InputKind::encoder) {
    to = unwrap(raw);
    raw = double(to.counts);
  } else if (channel_->kind == InputKind::encoder_velocity) {
    // A change of more than half the counter's width per sample cannot be distinguished from the opposite
    // direction.
    const double most = std::ldexp(1.0, channel_->counter_bits - 1);
    if (std::abs(raw) * period_s_ > most) to.reading = Reading::beyond_counter;
  } else {
    const double margin = beyond_range * (channel_->high - channel_->low);
    if (raw < channel_->low - margin || raw > channel_->high + margin) to.reading = Reading::beyond_range;
  }
  to.value = channel_->scale * raw + channel_->offset;
  if (to.reading == Reading::good && !std::isfinite(to.value)) to.reading = Reading::not_finite;
  return to;
}

Reading Input::take(double raw, int64_t instants) noexcept {
  instants_since_good_ += instants;
  Converted to = convert(raw);
  const double most = channel_->maximum_rate * period_s_ * double(instants_since_good_);
  if (to.reading == Reading::good && is_known_ && channel_->maximum_rate > 0 &&
      std::abs(to.value - value_) > most)
    to.reading = Reading::jump;
  if (to.reading != Reading::good) {
    ++bad_in_row_;
    return to.reading;
  }
  counter_ = to.counter, has_fitted_ = to.fits, counts_ = to.counts, value_ = to.value;
  bad_in_row_ = 0, instants_since_good_ = 0, is_known_ = true;
  return Reading::good;
}

}  // namespace loopwright::hw
