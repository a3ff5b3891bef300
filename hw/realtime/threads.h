/// Threads of a deployment: every one is joined, and one thread at a time uses the device.
#pragma once
#include <pthread.h>
#include <algorithm>
#include <atomic>
#include <ctime>
#include <functional>
#include <exception>
#include <string>
#include <thread>
#include "hw/realtime/crash_guard.h"

namespace loopwright::hw {

/// The text of an unexpected exception.
inline std::string text_of_exception() {
  try {
    throw;
  } catch (const std::exception& e) {
    return e.what();
  } catch (...) {
    return "an unknown exception";
  }
}

/// For the calling thread, where it is permitted. 0: it keeps the usual scheduling.
inline void raise_priority(int of_fifo) noexcept {
  const sched_param priority{std::min(of_fifo, 99)};
  if (of_fifo > 0) pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
}

/// A thread that is requested to end and joined, also when an exception is thrown.
class GuardedThread {
 public:
  GuardedThread(std::function<void()> run, std::function<void()> end)
      : end_(std::move(end)), thread_(std::move(run)) {}
  ~GuardedThread() {
    end_();
    thread_.join();
  }
  GuardedThread(const GuardedThread&) = delete;
  GuardedThread& operator=(const GuardedThread&) = delete;

 private:
  std::function<void()> end_;
  std::thread thread_;
};

/// The thread that uses the device now; 0: none. After a crash the guardian takes the device and keeps it.
class DeviceUser {
 public:
  /// The thread uses the device while this object lives. If the guardian has it, the process is about to end,
  /// and the constructor does not return.
  class Use {
   public:
    explicit Use(DeviceUser& user) : user_(user) {
      for (int none = 0; !user_.thread_.compare_exchange_strong(none, thread_number()); none = 0)
        wait_a_moment();
    }
    ~Use() { user_.thread_ = 0; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    DeviceUser& user_;
  };
  /// Whether a thread uses the device: it may hang in the driver.
  bool is_used() const noexcept { return thread_ != 0; }
  /// For the guardian: waits at most this long until the device is free, or until its user is the crashed
  /// thread.
  bool take_over(int crashed, int milliseconds) noexcept {
    for (int i = 0; i <= milliseconds; ++i) {
      for (int user : {0, crashed})
        if (thread_.compare_exchange_strong(user, thread_number())) return true;
      wait_a_moment();
    }
    return false;
  }

 private:
  static void wait_a_moment() noexcept {
    const timespec moment = {0, 1'000'000};
    nanosleep(&moment, nullptr);
  }
  std::atomic<int> thread_ = 0;
};

}  // namespace loopwright::hw
