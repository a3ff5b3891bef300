/// One input of a device: converts the raw number to a physical value, or states why it is implausible.
#pragma once
#include "hw/device/description.h"

namespace loopwright::hw {

/// Classification of a raw number. Everything but `good` leaves the value unchanged.
enum class Reading : uint8_t {
  good,
  not_finite,      ///< NaN or infinite, raw or as a value
  not_whole,       ///< a counter counts whole edges
  beyond_counter,  ///< impossible for a counter of this width, or counted too fast
  beyond_range,    ///< volts outside the input's range
  jump             ///< faster than the maximum rate
};

class Input {
 public:
  Input(const InputChannel& channel, double period_s) : channel_(&channel), period_s_(period_s) {}

  /// Converts the number of a sample, `instants` periods after the previous one. Defined for every double.
  /// Counts are unwrapped by differences modulo the counter's width.
  Reading take(double raw, int64_t instants) noexcept;
  /// Forgets the past: the next number is not compared with earlier ones.
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
  bool has_fitted_ = true;  // whether the last number was within the counter's width
  int64_t counts_ = 0;      // unwrapped
  double value_ = 0;
  int64_t instants_since_good_ = 0;
  int bad_in_row_ = 0;
  bool is_known_ = false;
};

}  // namespace loopwright::hw
