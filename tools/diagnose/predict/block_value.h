/// Values for settings of blocks that the diagnosis adds to a copy of the diagram.
#pragma once
#include <string>
#include "engine/json/value.h"

namespace loopwright::diagnosis {

inline Value text_value(std::string text) {
  Value value;
  value.kind = Value::Kind::text, value.text = std::move(text);
  return value;
}

/// Replaces the member of that name, or adds it.
inline void set_member(Value& object, const std::string& name, Value value) {
  object.kind = Value::Kind::object;
  for (Value::Member& member : object.members)
    if (member.name == name) {
      member.value = std::move(value);
      return;
    }
  object.members.push_back({name, object.place, std::move(value)});
}

}  // namespace loopwright::diagnosis
