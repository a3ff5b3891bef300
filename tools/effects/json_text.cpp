#include "tools/effects/json_text.h"
#include <algorithm>
#include <fmt/format.h>

namespace loopwright {
namespace {

size_t end_of_string(const std::string& text, size_t begin) {
  size_t at = begin + 1;
  while (at < text.size() && text[at] != '"') at += text[at] == '\\' ? 2 : 1;
  return at + 1;
}

size_t line_begin(const std::string& text, size_t at) {
  const size_t newline = at == 0 ? text.npos : text.rfind('\n', at - 1);
  return newline == text.npos ? 0 : newline + 1;
}

}  // namespace

size_t end_of_value(const std::string& text, size_t begin) {
  if (text[begin] == '"') return end_of_string(text, begin);
  if (text[begin] != '{' && text[begin] != '[')
    return std::min(text.find_first_of(",]} \t\r\n", begin), text.size());
  int depth = 0;
  for (size_t at = begin; at < text.size(); ++at) {
    if (text[at] == '"') {
      at = end_of_string(text, at) - 1;
      continue;
    }
    if (text[at] == '{' || text[at] == '[') ++depth;
    if ((text[at] == '}' || text[at] == ']') && --depth == 0) return at + 1;
  }
  return text.size();
}

std::string TextEdits::apply(const std::string& text) const {
  std::vector<const Edit*> ordered;
  for (const Edit& edit : edits_) ordered.push_back(&edit);
  std::ranges::stable_sort(ordered, {}, [](const Edit* e) { return e->begin; });
  std::string result;
  size_t at = 0;
  for (const Edit* edit : ordered) {
    result.append(text, at, edit->begin - at);
    result += edit->text;
    at = edit->end;
  }
  return result.append(text, at);
}

std::string indentation_at(const std::string& text, size_t at) {
  const size_t begin = line_begin(text, at);
  return text.substr(begin, std::min(text.find_first_not_of(" \t", begin), text.size()) - begin);
}

bool begins_line(const std::string& text, size_t at) {
  const size_t begin = line_begin(text, at);
  return text.find_first_not_of(" \t", begin) == at && (begin > 0);
}

std::string indented(const std::string& text, const std::string& by) {
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    result += text[i];
    const bool is_blank = i + 1 < text.size() && text[i + 1] == '\n';
    if (text[i] == '\n' && i + 1 < text.size() && !is_blank) result += by;
  }
  return result;
}

size_t width_of_names(const Value& object) {
  size_t width = 0;
  bool is_aligned = false;
  for (const Value::Member& member : object.members) {
    const size_t own = member.value.place.offset - member.place.offset;
    if (width != 0 && own != width) return 0;
    is_aligned |= own > member.name.size() + 4;  // quotes, colon and one space
    width = own;
  }
  return is_aligned ? width : 0;
}

std::string member_before(const Value& object, const Value::Member& next, const std::string& name,
                          const std::string& value) {
  const std::string& text = next.place.file->text;
  const size_t width = width_of_names(object);
  std::string member = fmt::format("\"{}\":", name);
  member += std::string(member.size() < width ? width - member.size() : 1, ' ');
  const bool has_own_line = begins_line(text, next.place.offset);
  const std::string indentation = indentation_at(text, next.place.offset);
  member += indented(value, indentation + (has_own_line ? std::string(member.size(), ' ') : "")) + ",";
  return member + (has_own_line ? "\n" + indentation : " ");
}

std::string readable_number(double number) { return fmt::format("{:.7g}", number); }

}  // namespace loopwright
