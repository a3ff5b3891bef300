#include "engine/diagram/wires.h"

#include <algorithm>
#include <fmt/format.h>

namespace loopwright {
namespace {

/// Removes "[12]" from the end of a port; false if its brackets are malformed.
bool drop_element(std::string_view& text) {
  const size_t bracket = text.find('[');
  if (bracket == text.npos) return true;
  const std::string_view element = text.substr(bracket);
  constexpr size_t most_digits = 6;
  const bool is_index = element.size() > 2 && element.size() <= 2 + most_digits && element.back() == ']' &&
                        element.find_first_not_of("0123456789", 1) == element.size() - 1;
  text = text.substr(0, bracket);
  return is_index;
}

bool is_pattern(std::string_view text) {
  if (text == "*") return true;
  return text.ends_with(".*") && is_port(text.substr(0, text.size() - 2)) && text.find('[') == text.npos;
}

Wire wire_at(const Value& value) { return {value.text, value.place}; }

PortWires read_port(const Value::Member& member, const Reader& reader) {
  PortWires port{member.name, member.place, member.value.kind == Value::Kind::list, {}};
  const auto add = [&](const Value& value) {
    if (value.kind == Value::Kind::text && is_port(value.text))
      port.wires.push_back(wire_at(value));
    else
      read_wire(value, fmt::format("the wire of the input \"{}\"", member.name),
                reader);  // reports the mistake
  };
  if (!port.is_list) {
    add(member.value);
    return port;
  }
  port.wires.reserve(member.value.items.size());
  for (const Value& item : member.value.items) add(item);
  return port;
}

}  // namespace

bool is_port(std::string_view text) {
  if (!drop_element(text)) return false;
  while (true) {
    const size_t dot = text.find('.');
    if (!is_name(text.substr(0, dot))) return false;
    if (dot == text.npos) return true;
    text.remove_prefix(dot + 1);
  }
}

Wire read_wire(const Value& value, std::string_view what, const Reader& reader) {
  const std::string_view expected = "a port in quotes, as in \"stage.position\" or \"gain.y[2]\"";
  if (!reader.expect(value, Value::Kind::text, what, expected)) return {};
  if (is_port(value.text)) return wire_at(value);
  Problem& problem = reader.error(value, fmt::format("{} does not name a port", what));
  problem.expected = expected;
  problem.found = shown(value);
  return {};
}

std::vector<PortWires> read_inputs(const Value& in, const Reader& reader) {
  std::vector<PortWires> ports;
  if (!reader.expect(in, Value::Kind::object, "\"in\"", "an object: {\"input\": \"block.output\"}"))
    return ports;
  ports.reserve(in.members.size());
  for (const Value::Member& member : in.members)
    if (reader.check_name(member, "an input")) ports.push_back(read_port(member, reader));
  return ports;
}

std::vector<Wire> read_log(const Value& log, const Reader& reader) {
  std::vector<Wire> wires;
  if (!reader.expect(log, Value::Kind::list, "\"log\"", "a list of ports")) return wires;
  for (const Value& item : log.items) {
    if (item.kind == Value::Kind::text && is_pattern(item.text))
      wires.push_back(wire_at(item));
    else if (Wire wire = read_wire(item, "an entry of \"log\"", reader); !wire.source.empty())
      wires.push_back(std::move(wire));
  }
  return wires;
}

}  // namespace loopwright
