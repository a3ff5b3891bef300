#include "hw/realtime/crash_guard.h"
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include "hw/realtime/stop_signals.h"

namespace loopwright::hw {
namespace {

constexpr int fatal[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP};

// Data for the handler, resolved beforehand. One deployment at a time in a process.
std::atomic<bool> is_guarded = false;
std::atomic<int> guardian = 0, crashed = 0;  // threads
std::atomic<const char*> last_words = nullptr, words_of_a_hanging_stop = nullptr;
std::atomic<int> wake = -1;
std::atomic<CrashGuard::Stop> last_resort = nullptr;
std::atomic<void*> last_resort_object = nullptr;
struct sigaction before[NSIG];
static_assert(std::atomic<CrashGuard::Stop>::is_always_lock_free);

/// Never blocks: a stopped terminal must not delay the end.
void say(const char* text) {
  pollfd event = {STDERR_FILENO, POLLOUT, 0};
  if (poll(&event, 1, 0) == 1 && (event.revents & POLLOUT))
    (void)!write(STDERR_FILENO, text, std::strlen(text));
}

/// If the guardian itself crashes, no thread is left to stop the machine: the call is made here, and the
/// process ends a second later if it hangs.
void stop_alone() {
  end_within(1);
  if (const auto stop = last_resort.load()) last_words = stop(last_resort_object);
  alarm(0);
}

/// Called by the first thread that crashes: stops the machine. Other threads wait until the process ends.
void stop_machine(const char* what) {
  int nobody = 0;
  const int self = thread_number();
  if (!crashed.compare_exchange_strong(nobody, self)) {
    if (nobody == self) return;  // second crash, during the shutdown
    poll(nullptr, 0, 2 * CrashGuard::patience_ms);
    return;
  }
  if (guardian == self) {
    stop_alone();
  } else if (guardian != 0) {
    const uint64_t one = 1;
    (void)!write(wake, &one, sizeof one);
    for (int i = 0; i < CrashGuard::patience_ms && !last_words.load(); ++i) poll(nullptr, 0, 1);
  }
  const char* words = last_words.load();
  if (!words) words = guardian == 0 ? "the device is not open" : words_of_a_hanging_stop.load();
  CrashGuard::say_at_end(what, words);
}

void on_fatal(int signal) {
  const int error = errno;
  stop_machine(name_of_signal(signal));
  sigaction(signal, &before[signal], nullptr);
  raise(signal);  // blocked until this returns
  errno = error;
}

void on_exit_call() {
  if (is_guarded && guardian != 0) stop_machine("exit()");
}

}  // namespace

int thread_number() noexcept { return int(syscall(SYS_gettid)); }

CrashGuard::CrashGuard() {
  if (is_guarded.exchange(true)) throw std::logic_error("two deployments at a time in one process");
  crashed = 0, guardian = 0, last_words = nullptr, words_of_a_hanging_stop = nullptr;
  wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (wake < 0) {
    is_guarded = false;
    throw std::runtime_error(std::string("no descriptor for the crash guard: ") + std::strerror(errno));
  }
  static const int once = std::atexit(on_exit_call);
  (void)once;
  struct sigaction action = {};
  action.sa_handler = on_fatal, action.sa_flags = SA_ONSTACK;
  sigfillset(&action.sa_mask);
  for (const int signal : fatal) sigaction(signal, &action, &before[signal]);
}

CrashGuard::~CrashGuard() {
  end_guardian();
  for (const int signal : fatal) sigaction(signal, &before[signal], nullptr);
  close(wake.exchange(-1));
  is_guarded = false;
}

void CrashGuard::begin_guardian(Stop stop, void* object) noexcept {
  last_resort_object = object, last_resort = stop;
  guardian = thread_number();
}
void CrashGuard::end_guardian() noexcept { guardian = 0, last_resort = nullptr; }
int CrashGuard::descriptor() const noexcept { return wake; }
int CrashGuard::crashed_thread() noexcept { return crashed; }
void CrashGuard::expect(const char* words) noexcept { words_of_a_hanging_stop = words; }
const char* CrashGuard::expected() noexcept { return words_of_a_hanging_stop; }
void CrashGuard::say_at_end(const char* what, const char* words) noexcept {
  for (const char* text :
       {"loopwright: ", what, ": ", words ? words : "the stop did not come to its end", "\n"})
    say(text);
}
void CrashGuard::release(const char* words) noexcept { last_words = words; }

HandlerStack::HandlerStack() : memory_(64 * 1024) {
  const stack_t stack = {memory_.data(), 0, memory_.size()};
  is_set_ = sigaltstack(&stack, &before_) == 0;
}
HandlerStack::~HandlerStack() {
  if (is_set_) sigaltstack(&before_, nullptr);
}

}  // namespace loopwright::hw
