/// Histogram of durations, in bins of a microsecond; adding allocates nothing.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

namespace loopwright::hw {

class Histogram {
 public:
  static constexpr int bins = 1000;  ///< [us]; longer durations are counted together

  void add(int64_t ns, int64_t cycle) noexcept {
    const int64_t positive = std::max<int64_t>(ns, 0);
    ++counts_[size_t(std::min<int64_t>(positive / 1000, bins))];
    ++count_, sum_ns_ += positive;
    if (positive > longest_ns_ || count_ == 1) longest_ns_ = positive, longest_cycle_ = cycle;
  }
  int64_t count() const { return count_; }
  int64_t longest_ns() const { return longest_ns_; }
  int64_t longest_cycle() const { return longest_cycle_; }
  double mean_us() const { return count_ ? 1e-3 * double(sum_ns_) / double(count_) : 0; }
  int64_t in_bin(int us) const { return counts_[size_t(us)]; }
  int64_t beyond() const { return counts_[bins]; }
  /// The end of the bin [us] below which the share lies; the longest duration if that is beyond all bins.
  double quantile_us(double share) const {
    int64_t seen = 0;
    for (int i = 0; i < bins; ++i)
      if ((seen += counts_[size_t(i)]) >= int64_t(share * double(count_)) && seen > 0) return i + 1;
    return 1e-3 * double(longest_ns_);
  }

 private:
  std::array<int64_t, bins + 1> counts_{};
  int64_t count_ = 0, sum_ns_ = 0, longest_ns_ = 0, longest_cycle_ = 0;
};

}  // namespace loopwright::hw
