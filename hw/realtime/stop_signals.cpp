#include "hw/realtime/stop_signals.h"
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/signalfd.h>
#include <unistd.h>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace loopwright::hw {
namespace {

constexpr int blocked[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGXCPU, SIGUSR1, SIGUSR2, SIGPWR};
constexpr int ignored[] = {SIGPIPE, SIGXFSZ, SIGTTIN, SIGTTOU};
constexpr int of_libraries[] = {SIGALRM, SIGVTALRM, SIGPROF, SIGIO, SIGSTKFLT};

std::atomic<int> stray = 0;  // a signal that reached the handler
static_assert(std::atomic<int>::is_always_lock_free);
void note(int signal) { stray = signal; }

/// In the calling thread the signal has its default action again.
void restore(int signal) noexcept {
  struct sigaction action = {};
  action.sa_handler = SIG_DFL;
  sigaction(signal, &action, nullptr);
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, signal);
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

}  // namespace

StopSignals::StopSignals() {
  sigemptyset(&set_);
  for (const int signal : blocked) sigaddset(&set_, signal);
  queue_ = signalfd(-1, &set_, SFD_CLOEXEC | SFD_NONBLOCK);
  if (queue_ < 0)
    throw std::runtime_error(std::string("signals cannot be collected: ") + std::strerror(errno));
  for (const int signal : ignored) handle(signal, SIG_IGN);
  for (const int signal : of_libraries) handle(signal, note);
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal) handle(signal, note);
  pthread_sigmask(SIG_BLOCK, &set_, &before_);
}

StopSignals::~StopSignals() {
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  for (const auto& [signal, action] : changed_) sigaction(signal, &action, nullptr);
  ::close(queue_);
}

void StopSignals::handle(int signal, void (*handler)(int)) {
  struct sigaction before, action = {};
  if (sigaction(signal, nullptr, &before) != 0 || before.sa_handler != SIG_DFL) return;
  action.sa_handler = handler, action.sa_flags = SA_RESTART;
  if (sigaction(signal, &action, nullptr) == 0) changed_.emplace_back(signal, before);
}

int StopSignals::wait(int milliseconds, int also) const noexcept {
  pollfd events[] = {{queue_, POLLIN, 0}, {also, POLLIN, 0}};
  poll(events, also < 0 ? 1 : 2, milliseconds);
  signalfd_siginfo info;
  if (read(queue_, &info, sizeof info) == ssize_t(sizeof info)) return int(info.ssi_signo);
  return stray.exchange(0);
}

void end_within(unsigned seconds) noexcept {
  restore(SIGALRM);
  alarm(seconds);
}

void end_by(int signal) noexcept {
  if (signal == 0) _exit(1);
  if (signal == SIGTSTP) _exit(128 + signal);  // its default action would only halt the process
  restore(signal);
  raise(signal);
  _exit(128 + signal);  // in case the signal is ignored
}

const char* name_of_signal(int signal) noexcept {
  static constexpr std::pair<int, const char*> names[] = {
      {SIGINT, "SIGINT"},   {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"},   {SIGQUIT, "SIGQUIT"},
      {SIGTSTP, "SIGTSTP"}, {SIGXCPU, "SIGXCPU"}, {SIGUSR1, "SIGUSR1"}, {SIGUSR2, "SIGUSR2"},
      {SIGPWR, "SIGPWR"},   {SIGALRM, "SIGALRM"}, {SIGSEGV, "SIGSEGV"}, {SIGBUS, "SIGBUS"},
      {SIGFPE, "SIGFPE"},   {SIGILL, "SIGILL"},   {SIGABRT, "SIGABRT"}, {SIGSYS, "SIGSYS"},
      {SIGTRAP, "SIGTRAP"}};
  for (const auto& [number, name] : names)
    if (number == signal) return name;
  return "a signal";
}

}  // namespace loopwright::hw
