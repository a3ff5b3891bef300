#include <fmt/format.h>
#include <algorithm>
#include <set>
#include "engine/diagram/names_elsewhere.h"
#include "tools/reference/reference.h"

namespace loopwright {
namespace {

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return lower;
}

/// Everything that a block says about itself.
std::string words_of(const BlockInfo& info) {
  std::string text = info.sentence;
  for (const auto* ports : {&info.inputs, &info.outputs})
    for (const PortInfo& port : *ports) text.append("\n").append(port.sentence);
  for (const ParameterInfo& parameter : info.parameters)
    text.append("\n").append(parameter.name).append("\n").append(parameter.sentence);
  return in_lower_case(text);
}

/// Also "anti-windup" for "anti_windup". Short words would be found across the borders of others.
bool says(const BlockInfo& info, const std::string& lower, const std::string& plain) {
  constexpr size_t longest_short_word = 4;
  const std::string words = words_of(info);
  return words.find(lower) != std::string::npos ||
         (plain.size() > longest_short_word && plain_name(words).find(plain) != std::string::npos);
}

std::string line(std::string_view name, std::string_view text) {
  return fmt::format("  {:<34} {}\n", name, text);
}

}  // namespace

std::string found_blocks(std::string_view words) {
  const std::string name = plain_name(words), lower = in_lower_case(words);
  std::string by_name, elsewhere, by_text;
  std::set<std::string, std::less<>> shown;
  for (const auto& [type, block] : all_blocks()) {
    const std::string plain = plain_name(type);
    if (name.empty() || (plain.find(name) == plain.npos && plain != without_number(name))) continue;
    by_name += line(type, block.info.sentence);
    shown.insert(type);
  }
  const NameElsewhere* const exact = find_name_elsewhere(words);
  for (const NameElsewhere& entry : names_elsewhere()) {
    const bool contains = name.size() > 1 && plain_name(entry.name).find(name) != std::string::npos;
    if (!contains && &entry != exact) continue;
    elsewhere += line(fmt::format("\"{}\"", entry.name), advice(entry));
    if (const BlockType* block = find_block(entry.block); block && shown.insert(block->info.type).second)
      elsewhere += line("  " + block->info.type, block->info.sentence);
  }
  for (const auto& [type, block] : all_blocks())
    if (!name.empty() && !shown.contains(type) && says(block.info, lower, name))
      by_text += line(type, block.info.sentence);
  std::string text;
  if (!by_name.empty()) text += "blocks\n" + by_name;
  if (!elsewhere.empty()) text += "names in other programs\n" + elsewhere;
  if (!by_text.empty()) text += "in descriptions\n" + by_text;
  return text;
}

}  // namespace loopwright
