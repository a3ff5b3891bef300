#include "tools/studio/session/member_change.h"
#include <fmt/format.h>
#include <algorithm>
#include "engine/json/json.h"
#include "tools/effects/json_text.h"

namespace loopwright::studio {
namespace {

const std::string& text_of(const Value& value) { return value.place.file->text; }

/// Where the entries of an object or a list begin, and where they end.
struct Span {
  size_t begin, end;
};

std::vector<Span> entries_of(const Value& value) {
  std::vector<Span> spans;
  for (const Value::Member& member : value.members)
    spans.push_back({member.place.offset, end_of(member.value)});
  for (const Value& item : value.items) spans.push_back({item.place.offset, end_of(item)});
  return spans;
}

std::string member_text(const Value& object, const std::string& name, const std::string& value) {
  std::string member = fmt::format("{}:", in_quotes(name));
  const size_t width = width_of_names(object);
  return member + std::string(member.size() < width ? width - member.size() : 1, ' ') + value;
}

TextChange with_entry(const Value& value, const std::string& entry, const std::string& indentation) {
  const std::string& text = text_of(value);
  const std::vector<Span> entries = entries_of(value);
  if (!entries.empty()) {
    const size_t at = entries.back().end;
    // Several entries share a line: a new one does too, if they do not begin it.
    const bool has_own_line = begins_line(text, entries.back().begin);
    const std::string between =
        has_own_line ? ",\n" + indentation_at(text, entries.back().begin) : std::string(", ");
    return {at, at, between + entry};
  }
  const size_t begin = value.place.offset + 1, end = end_of(value) - 1;
  if (indentation.empty()) return {begin, end, entry};
  const std::string outer = indentation_at(text, value.place.offset);
  return {begin, end, "\n" + indentation + entry + "\n" + outer};
}

TextChange without_entry(const Value& value, size_t index) {
  const std::vector<Span> entries = entries_of(value);
  if (entries.size() == 1) return {value.place.offset + 1, end_of(value) - 1, ""};
  if (index + 1 < entries.size()) return {entries[index].begin, entries[index + 1].begin, ""};
  return {entries[index - 1].end, entries[index].end, ""};
}

}  // namespace

size_t end_of(const Value& value) { return end_of_value(text_of(value), value.place.offset); }

std::string_view source_of(const Value& value) {
  return std::string_view(text_of(value)).substr(value.place.offset, end_of(value) - value.place.offset);
}

TextChange replaced(const Value& old, std::string text) {
  return {old.place.offset, end_of(old), std::move(text)};
}

TextChange renamed_member(const Value::Member& member, const std::string& to) {
  const std::string& text = member.place.file->text;
  size_t end = member.place.offset + 1;
  while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2 : 1;
  return {member.place.offset, end + 1, in_quotes(to)};
}

TextChange with_member(const Value& object, const std::string& name, const std::string& value,
                       const std::string& indentation) {
  return with_entry(object, member_text(object, name, value), indentation);
}

TextChange with_member_before(const Value& object, size_t index, const std::string& name,
                              const std::string& value) {
  const size_t at = object.members[index].place.offset;
  const bool has_own_line = begins_line(text_of(object), at);
  return {at, at,
          member_text(object, name, value) + "," +
              (has_own_line ? "\n" + indentation_at(text_of(object), at) : " ")};
}

TextChange with_item(const Value& list, const std::string& item) { return with_entry(list, item, ""); }

TextChange without_member(const Value& object, size_t index) { return without_entry(object, index); }
TextChange without_item(const Value& list, size_t index) { return without_entry(list, index); }

std::string in_quotes(std::string_view text) {
  Value value;
  value.kind = Value::Kind::text;
  value.text = text;
  return to_json(value);
}

}  // namespace loopwright::studio
