/// Signals that ask a program to end, collected instead of obeyed, so that a machine is stopped first.
#pragma once
#include <csignal>
#include <utility>
#include <vector>

namespace loopwright::hw {

/// While it lives, no signal that could be blocked or handled ends or halts the process:
///
/// - SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGXCPU, SIGUSR1, SIGUSR2 and SIGPWR are blocked and wait in
/// line for
///   wait(). SIGALRM, SIGVTALRM, SIGPROF, SIGIO, SIGSTKFLT and the real-time signals, which a vendor's
///   library may use, come to wait() too, unless somebody handles them.
/// - SIGPIPE, SIGXFSZ, SIGTTIN and SIGTTOU are ignored: the call that caused them fails instead.
///
/// What was ignored before (nohup) stays ignored. Make it before other threads begin, as they inherit the
/// blocking. Those of one process nest; the innermost one gets the signals. Signals of a crash: see
/// crash_guard.h.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Waits at most so long for a signal, or until `also`, a descriptor, can be read. The signal; 0: none.
  int wait(int milliseconds, int also = -1) const noexcept;

 private:
  void handle(int signal, void (*handler)(int));

  sigset_t set_, before_;
  std::vector<std::pair<int, struct sigaction>> changed_;
  int queue_ = -1;  // of the blocked ones
};

/// "SIGINT"; "a signal" where it is an unusual one.
const char* name_of_signal(int signal) noexcept;

}  // namespace loopwright::hw
