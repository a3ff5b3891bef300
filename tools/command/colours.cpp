#include "tools/command/colours.h"
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cstdlib>

namespace loopwright {
namespace {

struct Word {
  std::string_view text, sequence;
};
// ECMA-48, "select graphic rendition": 1 bold, 31 red, 33 yellow, 36 cyan, 0 as before.
constexpr std::array<Word, 2> severities = {{{"error:", "\033[1;31m"}, {"warning:", "\033[1;33m"}}};
constexpr std::array<std::string_view, 5> labels = {
    "  block:", "  at:", "  expected:", "  found:", "  hint:"};
constexpr std::string_view of_label = "\033[36m", bold = "\033[1m", as_before = "\033[0m";

void add(std::string& to, std::string_view sequence, std::string_view text) {
  if (!text.empty()) to.append(sequence).append(text).append(as_before);
}

/// "file:3:5: error: what", or "error: what".
bool add_severity(std::string& to, std::string_view line) {
  for (const Word& word : severities) {
    const size_t at = line.find(word.text);
    const bool is_severity = at == 0 || (at != line.npos && at > 2 && line.substr(at - 2, 2) == ": ");
    if (!is_severity || line.starts_with(' ')) continue;
    add(to, bold, line.substr(0, at));
    add(to, word.sequence, word.text);
    to += line.substr(at + word.text.size());
    return true;
  }
  return false;
}

void add_line(std::string& to, std::string_view line) {
  if (add_severity(to, line)) return;
  for (const std::string_view label : labels)
    if (line.starts_with(label)) {
      add(to, of_label, label);
      line.remove_prefix(label.size());
      break;
    }
  to += line;
}

}  // namespace

bool has_colours() {
  const char *refused = std::getenv("NO_COLOR"), *terminal = std::getenv("TERM");
  if ((refused && *refused) || !terminal || std::string_view(terminal) == "dumb") return false;
  return isatty(STDERR_FILENO);
}

std::string coloured(std::string_view text) {
  std::string to;
  while (!text.empty()) {
    const size_t length = std::min(text.find('\n'), text.size());
    add_line(to, text.substr(0, length));
    to += text.substr(length, 1);
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return to;
}

}  // namespace loopwright
