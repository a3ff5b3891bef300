#include "tools/command/take_over.h"
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

namespace loopwright {

void add_take_over(CLI::App& command, TakeOver& options) {
  command.add_flag(
      "--take-over", options.is_wanted,
      "Open a card that another program has open, after a question: it ends that program's motion");
  command.add_flag("--yes", options.is_agreed, "Answer the question of --take-over with yes");
}

/// Reads a line from the terminal; empty when it is closed or the user interrupts.
static std::string line_of_terminal(const std::function<bool()>& is_interrupted) {
  std::string line;
  for (;;) {
    pollfd terminal{STDIN_FILENO, POLLIN, 0};
    const int ready = poll(&terminal, 1, 100);
    if (is_interrupted()) return "";
    if (ready <= 0) continue;
    char c = 0;
    if (::read(STDIN_FILENO, &c, 1) != 1) return "";
    if (c == '\n') return line;
    line.push_back(c);
  }
}

bool agrees(const TakeOver& options, const std::string& who_has_it, const std::string& what_it_does,
            const std::function<bool()>& is_interrupted) {
  if (!options.is_wanted) return false;
  fmt::print(stderr, "{}\n{}\n", who_has_it, what_it_does);
  if (options.is_agreed) return true;
  if (!isatty(STDIN_FILENO)) {
    fmt::print(stderr, "--take-over asks on a terminal, and there is none: --yes answers it\n");
    return false;
  }
  fmt::print(stderr, "Take it over? Type yes: ");
  return line_of_terminal(is_interrupted) == "yes";
}

}  // namespace loopwright
