#include "engine/record/csv_syntax.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "engine/record/text.h"

namespace loopwright::csv {

Heading split_heading(std::string_view text) {
  const Heading whole{text, {}};
  const size_t open = text.rfind('[');
  if (!text.ends_with(']') || open == std::string_view::npos || open == 0) return whole;
  const std::string_view inside = text.substr(open + 1, text.size() - open - 2);
  const bool is_index = text[open - 1] != ' ' && inside.find_first_not_of("0123456789") == inside.npos;
  const std::string_view name = trim(text.substr(0, open));
  if (is_index || name.empty()) return whole;
  return {name, trim(inside)};
}

std::optional<double> parse_number(std::string_view text) {
  text = trim(text);
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || next != end) return std::nullopt;
  return number;
}

bool looks_like_number(std::string_view text) { return parse_number(text) || parse_decimal_comma(text); }

std::optional<double> parse_decimal_comma(std::string_view text) {
  if (std::ranges::count(text, ',') != 1) return std::nullopt;
  std::string with_point(text);
  std::ranges::replace(with_point, ',', '.');
  return parse_number(with_point);
}

namespace {

/// Reads from `at` to the separator at the end of the field, or to the end of the line.
Field next_field(std::string_view line, size_t& at, char separator) {
  const auto skip_blanks = [&] {
    while (at < line.size() && (line[at] == ' ' || line[at] == '\t') && line[at] != separator) ++at;
  };
  const auto at_end = [&] { return at >= line.size() || line[at] == separator; };
  while (separator == ' ' && at < line.size() && line[at] == ' ') ++at;
  skip_blanks();
  const size_t start = at;
  if (start < line.size() && line[start] == '"') {
    size_t close = line.find('"', start + 1);
    while (close != line.npos && line.substr(close, 2) == "\"\"") close = line.find('"', close + 2);
    if (close == line.npos) {
      at = line.size();
      return {line.substr(start + 1), true, true};
    }
    at = close + 1;
    skip_blanks();
    if (at_end()) return {line.substr(start + 1, close - start - 1), true, false};
  }
  while (!at_end()) ++at;
  return {trim(line.substr(start, at - start)), false, false};
}

}  // namespace

std::vector<Field> split(std::string_view line, char separator) {
  if (separator == ' ') line = trim(line);
  std::vector<Field> fields;
  for (size_t at = 0;; ++at) {
    fields.push_back(next_field(line, at, separator));
    if (at >= line.size()) return fields;
  }
}

std::string content(const Field& field) {
  std::string text;
  for (size_t i = 0; i < field.text.size(); ++i) {
    text += field.text[i];
    if (field.quoted && field.text.substr(i, 2) == "\"\"") ++i;
  }
  return text;
}

char find_separator(std::string_view header, std::string_view first_row) {
  for (const char separator : {'\t', ';', ',', ' '}) {
    const size_t fields = split(header, separator).size();
    if (fields > 1 && fields == split(first_row, separator).size()) return separator;
  }
  for (const char separator : {'\t', ';', ','})
    if (header.find(separator) != header.npos) return separator;
  return ',';
}

std::optional<char> stated_separator(std::string_view line) {
  constexpr std::string_view separators = ";,\t|", word = "sep=";
  if (line.size() == word.size() + 3 && line.starts_with('"') && line.ends_with('"'))
    line = line.substr(1, line.size() - 2);
  if (line.size() != word.size() + 1 || separators.find(line.back()) == separators.npos) return {};
  const bool is_word = std::ranges::equal(line.substr(0, word.size()), word, [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == b;
  });
  return is_word ? std::optional(line.back()) : std::nullopt;
}

}  // namespace loopwright::csv
