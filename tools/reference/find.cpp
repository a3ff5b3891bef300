#include <fmt/format.h>
#include <algorithm>
#include <set>
#include <sstream>
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

/// Each of several words, in whatever order.
bool says_each(const std::string& words, const std::string& lower) {
  std::istringstream list(lower);
  for (std::string word; list >> word;)
    if (words.find(word) == std::string::npos) return false;
  return true;
}

/// Also "anti-windup" for "anti_windup", and "inertia torque" where both are said. Short words would be found
/// across the borders of others.
bool says(const BlockInfo& info, const std::string& lower, const std::string& plain) {
  constexpr size_t longest_short_word = 4;
  const std::string words = words_of(info);
  return says_each(in_lower_case(info.type) + "\n" + words, lower) ||
         (plain.size() > longest_short_word && plain_name(words).find(plain) != std::string::npos);
}

std::string line(std::string_view name, std::string_view text) {
  return fmt::format("  {:<34} {}\n", name, text);
}

}  // namespace

std::vector<FoundBlock> find_blocks(std::string_view words) {
  using Where = FoundBlock::Where;
  const std::string name = plain_name(words), lower = in_lower_case(words);
  std::vector<FoundBlock> found;
  std::set<std::string, std::less<>> shown;
  for (const auto& [type, block] : all_blocks()) {
    const std::string plain = plain_name(type);
    if (name.empty() || (plain.find(name) == plain.npos && plain != without_number(name))) continue;
    found.push_back({Where::name, type, block.info.sentence, type});
    shown.insert(type);
  }
  const NameElsewhere* const exact = find_name_elsewhere(words);
  for (const NameElsewhere& entry : names_elsewhere()) {
    const bool contains = name.size() > 1 && plain_name(entry.name).find(name) != std::string::npos;
    if (!contains && &entry != exact) continue;
    const BlockType* block = find_block(entry.block);
    const bool is_new = block && shown.insert(block->info.type).second;
    found.push_back(
        {Where::elsewhere, fmt::format("\"{}\"", entry.name), advice(entry), is_new ? block->info.type : ""});
  }
  for (const auto& [type, block] : all_blocks())
    if (!name.empty() && !shown.contains(type) && says(block.info, lower, name))
      found.push_back({Where::description, type, block.info.sentence, type});
  return found;
}

std::string found_blocks(std::string_view words) {
  constexpr std::string_view titles[] = {"blocks\n", "names in other programs\n", "in descriptions\n"};
  std::string text;
  const FoundBlock* before = nullptr;
  const std::vector<FoundBlock> list = find_blocks(words);
  for (const FoundBlock& found : list) {
    if (!before || before->where != found.where) text += titles[size_t(found.where)];
    text += line(found.name, found.text);
    if (found.where == FoundBlock::Where::elsewhere && !found.type.empty())
      text += line("  " + found.type, find_block(found.type)->info.sentence);
    before = &found;
  }
  return text;
}

}  // namespace loopwright
