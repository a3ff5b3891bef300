/// The wires into a block as its author wrote them.
#pragma once
#include <algorithm>
#include <array>
#include <string_view>
#include "engine/json/value.h"

namespace loopwright::studio {

/// Keys of a subdiagram whose values are wires, beside those of "in".
inline constexpr std::array<std::string_view, 2> condition_keys = {"enabled_by", "triggered_by"};
inline bool is_condition(std::string_view port) {
  return std::ranges::find(condition_keys, port) != condition_keys.end();
}

/// What leads into a port of the block: a text or a list of texts. Null if nothing does.
inline const Value* wires_into(const Value& block, std::string_view port) {
  if (is_condition(port)) {
    const Value::Member* condition = block.find(port);
    return condition ? &condition->value : nullptr;
  }
  const Value::Member* in = block.find("in");
  const Value::Member* wires = in ? in->value.find(port) : nullptr;
  return wires ? &wires->value : nullptr;
}

/// f(port, wire, index) for every wire that is a text.
template <class F> void each_wire(const Value& block, F&& f) {
  const auto each_of = [&](const Value::Member& port) {
    if (port.value.kind == Value::Kind::text) f(port.name, port.value, size_t(0));
    for (size_t i = 0; i < port.value.items.size(); ++i)
      if (port.value.items[i].kind == Value::Kind::text) f(port.name, port.value.items[i], i);
  };
  if (const Value::Member* in = block.find("in"))
    for (const Value::Member& port : in->value.members) each_of(port);
  for (const std::string_view key : condition_keys)
    if (const Value::Member* condition = block.find(key)) each_of(*condition);
}

}  // namespace loopwright::studio
