#include "engine/record/mat_names.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <string_view>
#include <unordered_set>

namespace loopwright::mat {
namespace {

constexpr size_t longest_name = 63;  // MATLAB: namelengthmax

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_keyword(std::string_view name) {
  // MATLAB: iskeyword
  constexpr auto keywords = std::to_array<std::string_view>(
      {"break",      "case",   "catch",    "classdef", "continue", "else",      "elseif",
       "end",        "for",    "function", "global",   "if",       "otherwise", "parfor",
       "persistent", "return", "spmd",     "switch",   "try",      "while"});
  return std::ranges::find(keywords, name) != keywords.end();
}

/// Every sequence of characters other than letters and digits becomes one underscore: "motor.force[2]" →
/// "motor_force_2".
std::string legal_name(std::string_view name) {
  std::string legal;
  for (const char c : name) {
    if (is_letter(c) || is_digit(c) || c == '_')
      legal += c;
    else if (!legal.empty() && legal.back() != '_')
      legal += '_';
  }
  while (legal.ends_with('_') && !name.ends_with('_')) legal.pop_back();
  if (legal.empty() || !is_letter(legal.front()) || is_keyword(legal)) legal.insert(0, "x_");
  return legal.substr(0, longest_name);
}

}  // namespace

std::vector<std::string> legal_names(const std::vector<std::string>& names) {
  std::unordered_set<std::string> used = {names_variable, units_variable, facts_variable};
  std::vector<std::string> legal;
  for (const std::string& name : names) {
    const std::string base = legal_name(name);
    std::string candidate = base;
    for (int number = 2; !used.insert(candidate).second; ++number) {
      const std::string suffix = fmt::format("_{}", number);
      candidate = base.substr(0, longest_name - suffix.size()) + suffix;
    }
    legal.push_back(candidate);
  }
  return legal;
}

}  // namespace loopwright::mat
