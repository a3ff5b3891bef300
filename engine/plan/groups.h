/// Groups of numbers stored contiguously in one list: thousands of small vectors would be scattered over
/// memory.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace loopwright {

class Groups {
 public:
  Groups() = default;
  /// `each(f)` calls f(group, number) for every number. It is called twice: to count the numbers and to store
  /// them.
  template <class Each> Groups(size_t groups, const Each& each) : first_(groups + 1, 0) {
    each([&](size_t group, int) { ++first_[group + 1]; });
    for (size_t g = 0; g < groups; ++g) first_[g + 1] += first_[g];
    numbers_.resize(first_.back());
    std::vector<size_t> next(first_.begin(), first_.end() - 1);
    each([&](size_t group, int number) { numbers_[next[group]++] = number; });
  }
  /// In the order of the calls.
  std::span<const int> operator[](size_t group) const {
    return std::span(numbers_).subspan(first_[group], first_[group + 1] - first_[group]);
  }
  size_t size() const { return first_.size() - 1; }

 private:
  std::vector<size_t> first_ = {0};  // start of each group, and the end
  std::vector<int> numbers_;
};

}  // namespace loopwright
