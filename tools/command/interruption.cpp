#include "tools/command/interruption.h"
#include <unistd.h>
#include <csignal>
#include <cstring>
#include <ctime>
#include "tools/command/command.h"

namespace loopwright {
namespace {

constexpr long patience_ns = 700'000'000;  // the documented limit is a second, and ending takes some time too

std::atomic<bool> asked = false, may_take_time = false;
static_assert(std::atomic<bool>::is_always_lock_free);
timer_t deadline;
std::atomic<bool> has_deadline = false;

// Calls only functions that a signal handler may call.
void on_deadline(int) {
  if (may_take_time) return;
  constexpr char text[] = "\ninterrupted\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, text, std::strlen(text));
  _exit(interrupted);
}
void on_request(int) {
  if (asked.exchange(true)) _exit(interrupted);
  const itimerspec soon{{0, 0}, {0, patience_ns}};
  if (has_deadline) timer_settime(deadline, 0, &soon, nullptr);
}

}  // namespace

void obey_interruption() {
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL, event.sigev_signo = SIGALRM;
  has_deadline = timer_create(CLOCK_MONOTONIC, &event, &deadline) == 0;
  std::signal(SIGALRM, on_deadline);
  std::signal(SIGINT, on_request);
  std::signal(SIGTERM, on_request);
}

const std::atomic<bool>& interruption() { return asked; }

void take_time_after_interruption() {
  may_take_time = true;
  if (!has_deadline) return;
  has_deadline = false;
  timer_delete(deadline);
  std::signal(SIGALRM, SIG_DFL);  // an alarm from outside is a request to end like any other
}

}  // namespace loopwright
