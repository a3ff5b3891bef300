/// One input of a device: from the raw number that was read to a physical value, or why it cannot be one.
#pragma once
#include "hw/device/description.h"

namespace loopwright::hw {

/// What a raw number is. Everything but `good` leaves the value as it was.
enum class Reading : uint8_t {
  good,
  not_finite,      ///< NaN or infinite, raw or as a value
  not_whole,       ///< a counter counts whole edges
  beyond_counter,  ///< no counter of this width reads so, nor counts so fast
  beyond_range,    ///< volts that the input cannot see
  jump             ///< faster than the maximum rate
};

class Input {
 public:
  Input(const InputChannel& channel, double period_s) : channel_(&channel), period_s_(period_s) {}

  /// Takes the number of a sample, `instants` periods after the one before. Defined for every double. Counts
  /// are unwrapped by differences modulo the counter's width.
  Reading take(double raw, int64_t instants) noexcept;
  /// What is known of the past is forgotten: the next number stands alone.
  void forget() noexcept { is_known_ = false, bad_in_row_ = 0, instants_since_good_ = 0; }

  double value() const { return value_; }
  bool is_known() const { return is_known_; }
  int bad_in_row() const { return bad_in_row_; }

 private:
  struct Converted {
    Reading reading = Reading::good;
    double value = 0;
    uint32_t counter = 0;
    int64_t counts = 0;
    bool fits = true;
  };
  Converted convert(double raw) const noexcept;
  Converted unwrap(double raw) const noexcept;

  const InputChannel* channel_;
  double period_s_;
  uint32_t counter_ = 0;    // as last read, modulo 2^32
  bool has_fitted_ = true;  // whether that lay within the counter's width
  int64_t counts_ = 0;      // unwrapped
  double value_ = 0;
  int64_t instants_since_good_ = 0;
  int bad_in_row_ = 0;
  bool is_known_ = false;
};

}  // namespace loopwright::hw
