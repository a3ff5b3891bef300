#include "tools/studio/session/checked_text.h"
#include <fmt/format.h>
#include <algorithm>
#include "engine/diagram/in_memory.h"
#include "tools/effects/json_text.h"

namespace loopwright::studio {
namespace {

/// The word or value at a place, for underlining.
size_t end_of_word(const std::string& text, size_t begin) {
  return begin < text.size() ? std::min(end_of_value(text, begin), text.size()) : text.size();
}

std::string without_folder(const std::string& path, const std::string& folder) {
  return path.starts_with(folder + "/") ? path.substr(folder.size() + 1) : path;
}

}  // namespace

CheckedText check_text(const std::string& path, const std::string& text, const LoadOptions& options) {
  CheckedText result;
  result.parsed = std::make_shared<ParsedText>(path, text);
  result.checked =
      check_diagram(load_diagram_text(result.parsed->file, options, result.problems), result.problems);
  if (result.checked.plan)
    for (const Problem& warning : result.checked.plan->warnings) {
      const bool is_told = std::ranges::any_of(result.problems.list(), [&](const Problem& p) {
        return p.message == warning.message && p.place.offset == warning.place.offset;
      });
      if (!is_told) result.problems.add(warning);
    }
  return result;
}

Json problem_json(const Problem& problem, const ParsedText& parsed, const Utf16& places,
                  const std::string& folder) {
  const bool is_here = problem.place.file && problem.place.file->name == parsed.file->name;
  Json json{{"severity", problem.severity == Problem::Severity::error ? "error" : "warning"},
            {"text", to_string(problem)},
            {"message", printable(problem.message)},
            {"hint", printable(problem.hint)},
            {"file", problem.place.file ? without_folder(problem.place.file->name, folder) : ""}};
  if (problem.place.file) {
    const LineColumn at = line_column(problem.place);
    json["line"] = at.line, json["column"] = at.column;
  }
  if (is_here) {
    const size_t end = end_of_word(parsed.file->text, problem.place.offset);
    json["offset"] = places.units(problem.place.offset), json["end"] = places.units(end);
  }
  json["pointer"] = problem.pointer.empty() && is_here ? problem.place.pointer() : problem.pointer;
  json["block"] = problem.block, json["here"] = is_here;
  return json;
}

Json problems_json(std::span<const Problem> problems, const ParsedText& parsed, const std::string& folder) {
  const Utf16 places(parsed.file->text);
  Json list = Json::array();
  for (const Problem& problem : problems) {
    if (list.size() == most_problems_told) break;
    list.push_back(problem_json(problem, parsed, places, folder));
  }
  return list;
}

}  // namespace loopwright::studio
