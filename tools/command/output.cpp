#include "tools/command/output.h"
#include <fcntl.h>
#include <unistd.h>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include "engine/json/problem.h"
#include "tools/command/colours.h"

namespace loopwright {
namespace {

int first_failure = 0;  // errno of the first output that was lost
bool stdout_was_closed = false;

void note_failure(bool failed) {
  if (failed && first_failure == 0) first_failure = errno ? errno : EIO;
}

}  // namespace

void prepare_standard_streams() {
  for (int descriptor = 0; descriptor <= STDERR_FILENO; ++descriptor)
    if (fcntl(descriptor, F_GETFD) < 0 && errno == EBADF) {
      // A folder fails every write with EBADF, as the closed descriptor does, and cannot be opened for
      // writing under its name /dev/stdout. open() returns the lowest free number: this one.
      const bool is_stdout = descriptor == STDOUT_FILENO;
      stdout_was_closed |= is_stdout;
      const int opened = is_stdout ? open("/", O_RDONLY | O_DIRECTORY) : open("/dev/null", O_RDWR);
      if (opened > STDERR_FILENO) close(opened);
    }
  std::signal(SIGPIPE, SIG_IGN);  // a write then fails with EPIPE
  std::signal(SIGXFSZ, SIG_IGN);  // and a write beyond the file size limit with EFBIG
}

void tell_terminal(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    text.remove_prefix(size_t(written));
  }
}

void tell_text(std::string_view text) {
  static const bool on_colour_terminal = has_colours();
  tell_terminal(on_colour_terminal ? coloured(printable(text)) : printable(text));
}

void answer_data(std::string_view bytes) {
  errno = 0;
  note_failure(std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size());
}

void answer_text(std::string_view text) { answer_data(printable(text)); }

void remark_text(std::string_view text) {
  if (!stdout_was_closed) answer_text(text);
}

bool finish_answers() {
  errno = 0;
  note_failure(!std::cout.flush());
  note_failure(std::fflush(stdout) != 0);
  if (first_failure == 0) return !std::ferror(stdout);  // the code that printed a recording has reported it
  // A reader that stopped after reading what it needed, such as `head`, needs no message.
  if (first_failure != EPIPE)
    tell("error: the answer cannot be written: {}\n",
         stdout_was_closed ? "the standard output is closed" : std::strerror(first_failure));
  return false;
}

}  // namespace loopwright
