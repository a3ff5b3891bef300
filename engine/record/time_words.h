/// Names of time columns that tell what the numbers are, although no unit is stated.
#pragma once
#include <string>
#include <string_view>

namespace loopwright {

/// What the words of a name say: "t_ms" and "timestampMillis" say ms; "ticks" and "sample_index" say that the
/// numbers are counts. Both empty and false: nothing, or seconds.
struct TimeWords {
  std::string unit;         ///< "ms", "us", "ns", "min", "h" or "day"
  bool is_counted = false;  ///< no time at all before it is multiplied by the duration of one count
};
TimeWords time_words(std::string_view name);

}  // namespace loopwright
