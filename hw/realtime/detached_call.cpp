#include "hw/realtime/detached_call.h"
#include <atomic>
#include <chrono>
#include <ctime>
#include <semaphore>
#include <thread>
#include "hw/realtime/crash_guard.h"
#include "hw/realtime/threads.h"

namespace loopwright::hw {

using namespace std::chrono_literals;

/// Outlives the detached call if the call hangs.
struct DetachedCall::Shared {
  std::function<void()> call;
  std::atomic<bool> is_asked = false, is_over = false;
  std::binary_semaphore wakes{0}, ended{0};

  void serve() {
    const HandlerStack stack;
    while (!is_over) {
      wakes.acquire();
      if (is_over) break;
      call();
      is_asked = false;
    }
    call = nullptr;  // what it kept alive ends with the detached call
    ended.release();
  }
};

DetachedCall::DetachedCall(std::function<void()> call, int priority) : shared_(std::make_shared<Shared>()) {
  shared_->call = std::move(call);
  std::thread([shared = shared_, priority] {
    raise_priority(priority);
    shared->serve();
  }).detach();
}

DetachedCall::~DetachedCall() {
  const bool has_returned = wait(100);
  shared_->is_over = true;
  if (!has_returned) return;
  shared_->wakes.release();
  shared_->ended.try_acquire_for(100ms);
}

void DetachedCall::run() noexcept {
  if (!shared_->is_asked.exchange(true)) shared_->wakes.release();
}

bool DetachedCall::wait(int milliseconds) const noexcept {
  const timespec moment = {0, 1'000'000};
  for (int i = 0; i < milliseconds && shared_->is_asked; ++i) nanosleep(&moment, nullptr);
  return !shared_->is_asked;
}

}  // namespace loopwright::hw
