/// A thread for one call that may never return: who asks for the call does not wait in it.
#pragma once
#include <functional>
#include <memory>

namespace loopwright::hw {

class DetachedCall {
 public:
  /// The thread begins here, at this priority of SCHED_FIFO where that is permitted (0: the usual
  /// scheduling), so that asking for the call needs neither memory nor a new thread. What `call` uses must be
  /// kept alive by `call` itself.
  DetachedCall(std::function<void()> call, int priority);
  /// A call that does not return is left behind with its thread.
  ~DetachedCall();
  DetachedCall(const DetachedCall&) = delete;
  DetachedCall& operator=(const DetachedCall&) = delete;

  /// Asks for a call; returns at once. Ignored if one has been asked for that has not ended.
  void run() noexcept;
  /// Waits at most this long for the end of the call. False: it has not returned.
  bool wait(int milliseconds) const noexcept;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace loopwright::hw
