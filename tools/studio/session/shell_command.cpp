#include "tools/studio/session/shell_command.h"

namespace loopwright::studio {

std::string shell_word(const std::string& text) {
  if (text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./=-+,") ==
          text.npos &&
      !text.empty())
    return text;
  std::string word = "'";
  for (char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::string options_text(const LoadOptions& options) {
  std::string text;
  for (const auto& [name, value] : options.set) text += " --set " + shell_word(name + "=" + value);
  for (const auto& [block, variant] : options.variants)
    text += " --variant " + shell_word(block + "=" + variant);
  return text;
}

}  // namespace loopwright::studio
