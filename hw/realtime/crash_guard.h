/// The last stop: the actions between a crash of the process and its end.
///
/// A fatal signal (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP) may hit any thread anywhere,
/// with any lock held, so its handler calls no driver and allocates nothing. It wakes a guardian, an
/// unaffected thread whose only task this is, and the guardian stops the machine. The handler waits for it at
/// most `patience_ms`, writes a final message to standard error, and forwards the signal to the previous
/// handler. By default that ends the process, whose exit status then shows the signal. exit() from any thread
/// is handled the same way.
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

  /// Stops the machine and returns a final message of static lifetime.
  using Stop = const char* (*)(void* object);

  /// Called by the guardian's thread when it begins. If the guardian itself crashes, `last_resort` is called
  /// in the handler, and the process ends after a second if that hangs.
  void begin_guardian(Stop last_resort, void* object) noexcept;
  /// Called when the guardian ends: a crash after that only ends the process.
  void end_guardian() noexcept;
  /// Becomes readable at a crash.
  int descriptor() const noexcept;
  /// The thread that crashed; 0: none.
  static int crashed_thread() noexcept;
  /// The final message if the stop does not come to its end, of static lifetime. It changes with the state of
  /// the device. Without a guardian the device is not open, and the message says so.
  static void expect(const char* words) noexcept;
  static const char* expected() noexcept;
  /// "loopwright: what: words" on standard error; waits for no reader.
  static void say_at_end(const char* what, const char* words) noexcept;
  /// The guardian has finished.
  void release(const char* last_words) noexcept;
};

/// A stack for the signal handler of the calling thread while this object lives: a stack that overflowed has
/// no room for it.
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

/// The system's number of the calling thread.
int thread_number() noexcept;

}  // namespace loopwright::hw
