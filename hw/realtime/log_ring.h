/// Rows of numbers from the loop to the log writer: one producer, one consumer, no lock. The producer never
/// waits: a row that does not fit is dropped and counted.
#pragma once
#include <atomic>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace loopwright::hw {

class LogRing {
 public:
  LogRing(size_t columns, size_t rows) : columns_(columns), rows_(rows), numbers_(columns * rows) {}

  bool has_room() const noexcept {
    return end_.load(std::memory_order_relaxed) - begin_.load(std::memory_order_acquire) < rows_;
  }
  void push(std::span<const double> row) noexcept {
    if (!has_room()) {
      drops_.store(drops_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return;
    }
    const size_t end = end_.load(std::memory_order_relaxed);
    std::memcpy(&numbers_[end % rows_ * columns_], row.data(), columns_ * sizeof(double));
    end_.store(end + 1, std::memory_order_release);
  }
  /// Calls take(row) for every available row.
  template <class Take> void drain(Take&& take) {
    size_t begin = begin_.load(std::memory_order_relaxed);
    for (const size_t end = end_.load(std::memory_order_acquire); begin != end; ++begin) {
      take(std::span<const double>(&numbers_[begin % rows_ * columns_], columns_));
      begin_.store(begin + 1, std::memory_order_release);
    }
  }
  size_t columns() const { return columns_; }
  /// Number of rows not yet taken.
  size_t waiting() const {
    return end_.load(std::memory_order_acquire) - begin_.load(std::memory_order_acquire);
  }
  int64_t drops() const { return drops_.load(std::memory_order_relaxed); }

 private:
  const size_t columns_, rows_;
  std::vector<double> numbers_;
  alignas(64) std::atomic<size_t> begin_ = 0;
  alignas(64) std::atomic<size_t> end_ = 0;
  std::atomic<int64_t> drops_ = 0;
};

}  // namespace loopwright::hw
