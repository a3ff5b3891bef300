#include "engine/json/problem.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace loopwright {
namespace {

/// Walks forward through one text and counts lines and characters, so that many places cost one pass.
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
  return text;
}

std::string counted(size_t number, std::string_view noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

// Edit costs: a slip in upper or lower case is half a mistake.
constexpr int case_cost = 1, edit_cost = 2;

/// Damerau-Levenshtein distance (insert, remove, replace, swap of neighbours) in the costs above.
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

bool Problems::has_errors() const {
  return std::ranges::any_of(list_, [](const Problem& p) { return p.severity == Problem::Severity::error; });
}

std::string Problems::text() const {
  if (list_.empty()) return {};
  std::vector<const Problem*> sorted;
  for (const Problem& problem : list_) sorted.push_back(&problem);
  std::ranges::stable_sort(sorted, {},
                           [](const Problem* p) { return std::pair(file_name(*p), p->place.offset); });

  std::string text;
  size_t errors = 0;
  const SourceFile* file = nullptr;
  LineCounter counter{{}};
  for (const Problem* problem : sorted) {
    if (problem->place.file && problem->place.file.get() != file) {
      file = problem->place.file.get();
      counter = LineCounter(file->text);
    }
    text += message_at(*problem, counter.advance_to(problem->place.offset)) + '\n';
    errors += problem->severity == Problem::Severity::error;
  }
  const size_t warnings = sorted.size() - errors;
  if (errors > 0) text += counted(errors, "error");
  if (errors > 0 && warnings > 0) text += ", ";
  if (warnings > 0) text += counted(warnings, "warning");
  return text;
}

std::string nearest_name(std::string_view wrong, const std::vector<std::string>& candidates) {
  constexpr size_t longest_name = 64;  // bounds the work on hostile input
  if (wrong.empty() || wrong.size() > longest_name) return {};
  std::string_view nearest;
  int nearest_distance = 0;
  for (std::string_view candidate : candidates) {
    if (candidate.empty() || candidate.size() > longest_name) continue;
    // One mistake in three letters is still the same word; more is a guess.
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
