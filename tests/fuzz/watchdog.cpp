#include "tests/fuzz/watchdog.h"
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <sys/time.h>
#include <unistd.h>

extern "C" void __sanitizer_set_death_callback(void (*)()) __attribute__((weak));

namespace loopwright::fuzz {
namespace {

constexpr long most_work = 20, longest_wait = 600;  // s, of processor time and of wall-clock time

const std::string* watched = nullptr;
unsigned long long watched_seed = 0;

/// Only functions that are allowed in a signal handler.
void write_text(const char* text, size_t length) {
  while (length > 0) {
    const ssize_t written = write(STDERR_FILENO, text, length);
    if (written <= 0) return;
    text += written, length -= size_t(written);
  }
}
void name_the_mutant() {
  if (!watched) return;
  char head[64];
  const int length = std::snprintf(head, sizeof head, "\n==== the mutant of seed %llu\n", watched_seed);
  write_text(head, size_t(length));
  write_text(watched->data(), watched->size());
  write_text("\n====\n", 6);
  watched = nullptr;
}
void on_signal(int signal) {
  if (signal == SIGVTALRM || signal == SIGALRM) write_text("\n==== too slow\n", 15);
  name_the_mutant();
  std::signal(signal, SIG_DFL);
  std::abort();
}

void install() {
  for (int signal : {SIGVTALRM, SIGALRM}) std::signal(signal, on_signal);
  if (__sanitizer_set_death_callback)
    __sanitizer_set_death_callback(name_the_mutant);  // it reports crashes itself
  else
    for (int signal : {SIGSEGV, SIGFPE, SIGBUS, SIGILL, SIGABRT}) std::signal(signal, on_signal);
}

void arm(long work, long wait) {
  const itimerval timer{{0, 0}, {work, 0}};
  setitimer(ITIMER_VIRTUAL, &timer, nullptr);
  alarm(unsigned(wait));
}

}  // namespace

void watch(unsigned long long seed, const std::string& text) {
  static const bool installed = (install(), true);
  (void)installed;
  watched = &text, watched_seed = seed;
  arm(most_work, longest_wait);
}
void unwatch() {
  arm(0, 0);
  watched = nullptr;
}

}  // namespace loopwright::fuzz
