/// Members and items of a JSON text that are added, replaced or removed in the style of their author.
#pragma once
#include <string>
#include "engine/json/value.h"
#include "tools/studio/session/text_change.h"

namespace loopwright::studio {

/// One past the last character of a value.
size_t end_of(const Value& value);
/// The characters of a value as its author wrote them.
std::string_view source_of(const Value& value);

/// A new value in place of an old one.
TextChange replaced(const Value& old, std::string text);
/// A member under another name.
TextChange renamed_member(const Value::Member& member, const std::string& to);
/// A new member behind the last one: on a line of its own if that has its own line, and with its value in the
/// same column if those of the object are aligned. `indentation` is that of the first member of an empty
/// object that gets a line for each member; empty: it stays on one line.
TextChange with_member(const Value& object, const std::string& name, const std::string& value,
                       const std::string& indentation = "");
/// The same before an existing member.
TextChange with_member_before(const Value& object, size_t index, const std::string& name,
                              const std::string& value);
TextChange with_item(const Value& list, const std::string& item);
/// Without one of its members, and without the comma and the line that it leaves behind.
TextChange without_member(const Value& object, size_t index);
TextChange without_item(const Value& list, size_t index);

/// A text in quotes.
std::string in_quotes(std::string_view text);

}  // namespace loopwright::studio
