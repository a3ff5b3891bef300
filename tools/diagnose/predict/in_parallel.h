/// Independent parts of a computation on all processors.
#pragma once
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace loopwright::diagnosis {

/// Calls f(0) … f(count - 1), in any order. Each call writes to places of its own, so that the result does
/// not depend on the number of processors. The first exception is thrown again after all threads have ended.
template <class F> void in_parallel(size_t count, F&& f) {
  std::atomic<size_t> next = 0;
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    try {
      for (size_t i = next++; i < count; i = next++) f(i);
    } catch (...) {
      next = count;
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  std::vector<std::jthread> threads;
  const size_t helpers = std::min<size_t>(count, std::thread::hardware_concurrency());
  try {
    for (size_t i = 1; i < helpers; ++i) threads.emplace_back(work);
  } catch (const std::system_error&) {  // fewer threads do the same
  }
  work();
  threads.clear();  // waits for them
  if (failure) std::rethrow_exception(failure);
}

}  // namespace loopwright::diagnosis
