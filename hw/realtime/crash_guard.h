/// The last stop: what happens between a crash of the process and its end.
///
/// A fatal signal (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP) may hit any thread anywhere,
/// with any lock held, so its handler calls no driver and allocates nothing. It wakes a guardian, a healthy
/// thread that waits for nothing else, lets it stop the machine, waits for it at most `patience_ms`, writes
/// its last words to standard error, and hands the signal on to whoever had it before: by default it ends the
/// process, whose exit status so tells the signal. exit() from anywhere takes the same way.
#pragma once
#include <csignal>
#include <vector>

namespace loopwright::hw {

class CrashGuard {
 public:
  static constexpr int patience_ms = 1000;

  CrashGuard();
  ~CrashGuard();
  CrashGuard(const CrashGuard&) = delete;
  CrashGuard& operator=(const CrashGuard&) = delete;

  /// What stops the machine, and answers with last words of static life.
  using Stop = const char* (*)(void* object);

  /// Called by the guardian's thread when it begins. Where the guardian itself crashes, `last_resort` is
  /// called in the handler, and the process ends after a second if it hangs there.
  void begin_guardian(Stop last_resort, void* object) noexcept;
  /// Called when the guardian ends: a crash after that only ends the process.
  void end_guardian() noexcept;
  /// Readable from a crash on.
  int descriptor() const noexcept;
  /// The thread that crashed; 0: none has.
  static int crashed_thread() noexcept;
  /// The guardian has done what it could.
  void release(const char* last_words) noexcept;
};

/// A stack for the handler, of the calling thread while this lives: a stack that overflowed has no room for
/// it.
class HandlerStack {
 public:
  HandlerStack();
  ~HandlerStack();
  HandlerStack(const HandlerStack&) = delete;
  HandlerStack& operator=(const HandlerStack&) = delete;

 private:
  std::vector<char> memory_;
  stack_t before_ = {};
  bool is_set_ = false;
};

/// Number of the calling thread in this system.
int thread_number() noexcept;

}  // namespace loopwright::hw
