#include "engine/json/problem.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include "engine/file/hash.h"

namespace loopwright {
namespace {

/// Scans a text forward and counts lines and characters, so that many locations need only one pass.
class LineCounter {
 public:
  explicit LineCounter(std::string_view text) : text_(text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text_.starts_with(byte_order_mark)) offset_ = byte_order_mark.size();
  }

  LineColumn advance_to(size_t offset) {
    offset = std::min(offset, text_.size());
    for (; offset_ < offset; ++offset_) {
      const auto byte = static_cast<unsigned char>(text_[offset_]);
      const bool continues_character = (byte & 0xC0) == 0x80;  // UTF-8
      if (byte == '\n') {
        ++position_.line;
        position_.column = 1;
      } else if (!continues_character) {
        ++position_.column;
      }
    }
    return position_;
  }

 private:
  std::string_view text_;
  size_t offset_ = 0;
  LineColumn position_;
};

std::string_view file_name(const Problem& problem) {
  return problem.place.file ? std::string_view(problem.place.file->name) : std::string_view();
}

std::string message_at(const Problem& problem, LineColumn position) {
  std::string text;
  if (problem.place.file) {
    text = fmt::format("{}:{}:{}: ", problem.place.file->name, position.line, position.column);
  }
  text += problem.severity == Problem::Severity::error ? "error: " : "warning: ";
  text += problem.message;
  const auto detail = [&text](std::string_view label, std::string_view content) {
    if (!content.empty()) text += fmt::format("\n  {}: {}", label, content);
  };
  detail("block", problem.block);
  detail("at", problem.pointer);
  detail("expected", problem.expected);
  detail("found", problem.found);
  detail("hint", problem.hint);
  return printable(text);
}

/// "99,800"
std::string with_commas(size_t number) {
  std::string text = std::to_string(number);
  for (size_t end = text.size(); end > 3; end -= 3) text.insert(end - 3, 1, ',');
  return text;
}

std::string counted(size_t number, std::string_view noun) {
  return fmt::format("{} {}{}", with_commas(number), noun, number == 1 ? "" : "s");
}

bool is_error(const Problem& problem) { return problem.severity == Problem::Severity::error; }

/// Length in bytes of the UTF-8 character at the start of the text; 0: none.
size_t length_of_character(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  const size_t length = byte(0) < 0x80   ? 1
                        : byte(0) < 0xC2 ? 0
                        : byte(0) < 0xE0 ? 2
                        : byte(0) < 0xF0 ? 3
                        : byte(0) < 0xF5 ? 4
                                         : 0;
  if (length == 0 || text.size() < length) return 0;
  for (size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  const bool is_overlong = (byte(0) == 0xE0 && byte(1) < 0xA0) || (byte(0) == 0xF0 && byte(1) < 0x90);
  const bool is_surrogate = byte(0) == 0xED && byte(1) >= 0xA0;
  const bool is_beyond = byte(0) == 0xF4 && byte(1) >= 0x90;
  return is_overlong || is_surrogate || is_beyond ? 0 : length;
}

/// Control characters of ASCII and of Latin-1 (U+0080 to U+009F, which can also begin an escape sequence).
bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  return first < 0x20 || first == 0x7F || (first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0);
}

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

// Edit costs: a wrong case counts as half a mistake.
constexpr int case_cost = 1, edit_cost = 2;

/// Damerau-Levenshtein distance (insert, remove, replace, swap of neighbors) with the costs above.
int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> two_above(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<int>(j) * edit_cost;
  for (size_t i = 1; i <= a.size(); ++i) {
    std::swap(two_above, above);
    std::swap(above, row);
    row[0] = static_cast<int>(i) * edit_cost;
    for (size_t j = 1; j <= b.size(); ++j) {
      const char x = a[i - 1], y = b[j - 1];
      const int replace = x == y ? 0 : lower(x) == lower(y) ? case_cost : edit_cost;
      row[j] = std::min({above[j] + edit_cost, row[j - 1] + edit_cost, above[j - 1] + replace});
      if (i > 1 && j > 1 && x == b[j - 2] && a[i - 2] == y)
        row[j] = std::min(row[j], two_above[j - 2] + edit_cost);
    }
  }
  return row[b.size()];
}

}  // namespace

LineColumn line_column(const Place& place) {
  if (!place.file) return {};
  return LineCounter(place.file->text).advance_to(place.offset);
}

std::string to_string(const Problem& problem) { return message_at(problem, line_column(problem.place)); }

Problem& Problems::error(Place place, std::string pointer, std::string block, std::string message) {
  Problem& problem = list_.emplace_back();
  problem.place = std::move(place);
  problem.pointer = std::move(pointer);
  problem.block = std::move(block);
  problem.message = std::move(message);
  return problem;
}

Problem& Problems::warning(Place place, std::string pointer, std::string block, std::string message) {
  Problem& problem = error(std::move(place), std::move(pointer), std::move(block), std::move(message));
  problem.severity = Problem::Severity::warning;
  return problem;
}

bool Problems::has_errors() const { return std::ranges::any_of(list_, is_error); }

std::string printable(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const size_t length = length_of_character(text);
    const std::string_view character = text.substr(0, std::max<size_t>(1, length));
    if (length > 0 && (character == "\n" || !is_control(character)))
      shown += character;
    else
      for (const char byte : character) shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
    text.remove_prefix(character.size());
  }
  return shown;
}

std::string to_text(std::span<const Problem> problems) {
  std::vector<const Problem*> told;
  for (const Problem& problem : problems) told.push_back(&problem);
  if (told.size() > most_problems_told) {
    std::ranges::stable_partition(told, [](const Problem* p) { return is_error(*p); });
    told.resize(most_problems_told);
  }
  std::ranges::stable_sort(told, {},
                           [](const Problem* p) { return std::pair(file_name(*p), p->place.offset); });

  std::string text;
  const SourceFile* file = nullptr;
  LineCounter counter{{}};
  for (const Problem* problem : told) {
    if (problem->place.file && problem->place.file.get() != file) {
      file = problem->place.file.get();
      counter = LineCounter(file->text);
    }
    text += message_at(*problem, counter.advance_to(problem->place.offset)) + '\n';
  }
  if (told.size() < problems.size())
    text += fmt::format("… and {} more\n", with_commas(problems.size() - told.size()));
  return text;
}

std::string Problems::text() const {
  if (list_.empty()) return {};
  const auto errors = static_cast<size_t>(std::ranges::count_if(list_, is_error));
  const size_t warnings = list_.size() - errors;
  std::string text = to_text(list_);
  if (errors > 0) text += counted(errors, "error");
  if (errors > 0 && warnings > 0) text += ", ";
  if (warnings > 0) text += counted(warnings, "warning");
  return text;
}

void Problems::add(const Problems& part) {
  list_.insert(list_.end(), part.list_.begin(), part.list_.end());
  files_.insert(files_.end(), part.files_.begin(), part.files_.end());
}

void Problems::note_file(const std::string& path, std::string_view bytes) {
  files_.push_back({path, content_hash(bytes)});
}

std::string nearest_name(std::string_view wrong, const std::vector<std::string>& candidates) {
  constexpr size_t longest_name = 64;  // limits the work for hostile input
  if (wrong.empty() || wrong.size() > longest_name) return {};
  std::string_view nearest;
  int nearest_distance = 0;
  for (std::string_view candidate : candidates) {
    if (candidate.empty() || candidate.size() > longest_name) continue;
    // One mistake in three letters is accepted as the same word; more would be a guess.
    const int allowed = edit_cost * static_cast<int>(std::max(wrong.size(), candidate.size()) + 1) / 3;
    const int length_difference =
        std::abs(static_cast<int>(wrong.size()) - static_cast<int>(candidate.size()));
    if (length_difference * edit_cost > allowed) continue;
    const int distance = edit_distance(wrong, candidate);
    if (distance > allowed || (!nearest.empty() && distance >= nearest_distance)) continue;
    nearest = candidate;
    nearest_distance = distance;
  }
  return std::string(nearest);
}

}  // namespace loopwright
