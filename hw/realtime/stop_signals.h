/// Signals that request the end of a program, collected so that the machine is stopped first.
#pragma once
#include <csignal>
#include <utility>
#include <vector>

namespace loopwright::hw {

/// While this object lives, no signal that can be blocked or handled ends or halts the process:
///
/// - SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGXCPU, SIGUSR1, SIGUSR2 and SIGPWR are blocked and queued
///   for wait(). SIGALRM, SIGVTALRM, SIGPROF, SIGIO, SIGSTKFLT and the real-time signals, which a vendor's
///   library may use, also reach wait(), unless they have a handler.
/// - SIGPIPE, SIGXFSZ, SIGTTIN and SIGTTOU are ignored: the call that caused them fails instead.
///
/// Signals that were ignored before (nohup) stay ignored. Create it before other threads begin, because they
/// inherit the signal mask. Several objects of one process nest; the innermost one gets the signals. For
/// crash signals see crash_guard.h.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Waits at most this long for a signal, or until the descriptor `also` is readable. Returns the signal; 0:
  /// none.
  int wait(int milliseconds, int also = -1) const noexcept;

 private:
  void handle(int signal, void (*handler)(int));

  sigset_t set_, before_;
  std::vector<std::pair<int, struct sigaction>> changed_;
  int queue_ = -1;  // of the blocked ones
};

/// The process ends after this time at the latest, by SIGALRM, unless alarm(0) comes before.
void end_within(unsigned seconds) noexcept;

/// Ends the process at once by the default action of the signal, or with exit code 1 if it is 0. Nothing else
/// is done: threads may hang.
[[noreturn]] void end_by(int signal) noexcept;

/// "SIGINT"; "a signal" for an unusual one.
const char* name_of_signal(int signal) noexcept;

}  // namespace loopwright::hw
