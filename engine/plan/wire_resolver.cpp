#include "engine/plan/wire_resolver.h"
#include <fmt/format.h>
#include <algorithm>
#include "engine/plan/gates.h"

namespace loopwright {

static FlatWire unresolved(const Wire& at) {
  FlatWire wire;
  wire.at = &at;
  return wire;
}

FlatWire WireResolver::resolve(Scope& scope, std::string_view text, const Wire& at, const std::string& reader,
                               int depth) {
  if (depth > 200) return fail(at, reader, "the wire leads round in a circle of subdiagram outputs", {}, "");
  const size_t dot = text.find('.');
  const std::string_view head = text.substr(0, dot);
  if (dot == text.npos) {
    const auto bracket = head.find('[');
    return resolve_input(scope, std::string(head.substr(0, bracket)),
                         std::string(bracket == head.npos ? "" : head.substr(bracket)), at, reader, depth);
  }
  const std::string_view rest = text.substr(dot + 1);
  if (const int block = scope.blocks.find(head); block >= 0) {
    const auto& [flat_block, inner] = scope.parts[size_t(block)];
    if (inner) return resolve_inside(*inner, rest, at, reader, depth);
    if (flat_block >= 0) return resolve_port(flat_block, rest, at, reader, depth);
    return unresolved(at);  // already reported
  }
  std::vector<std::string> names;
  for (const BlockEntry& entry : scope.diagram->blocks) names.push_back(entry.name);
  return fail(at, reader, fmt::format("there is no block \"{}{}\"", scope.prefix, head), names,
              std::string(head));
}

FlatWire WireResolver::resolve_input(Scope& scope, const std::string& name, const std::string& element,
                                     const Wire& at, const std::string& reader, int depth) {
  std::vector<std::string> names;
  for (const DiagramInput& input : scope.diagram->inputs) {
    if (input.name == name) {
      if (!scope.parent && open_) {
        FlatWire wire = unresolved(at);
        wire.output = int(&input - scope.diagram->inputs.data());
        return wire;
      }
      if (!scope.parent)
        return fail(at, reader,
                    fmt::format("the input \"{}\" of the diagram has no source: it is the top", name), {},
                    "");
      for (const PortWires& wires : scope.entry->in)
        if (wires.port == name && wires.wires.size() == 1) {
          FlatWire wire =
              resolve(*scope.parent, wires.wires[0].source, wires.wires[0], scope.prefix + name, depth + 1);
          return with_element(wire, element, at, reader);
        }
      return {};  // reported by check_subdiagram_wires
    }
    names.push_back(input.name);
  }
  for (const BlockEntry& entry : scope.diagram->blocks) names.push_back(entry.name + ".…");
  return fail(
      at, reader,
      fmt::format("\"{}\" is neither an input of this diagram nor of the form block.output", at.source),
      names, name, outputs_of(scope, name));
}

FlatWire WireResolver::resolve_inside(Scope& inner, std::string_view rest, const Wire& at,
                                      const std::string& reader, int depth) {
  const size_t bracket = rest.find('[');
  const std::string name(rest.substr(0, bracket)), element(bracket == rest.npos ? "" : rest.substr(bracket));
  std::vector<std::string> names;
  for (size_t o = 0; o < inner.diagram->outputs.size(); ++o) {
    const DiagramOutput& output = inner.diagram->outputs[o];
    if (output.name == name) return with_element(output_of(inner, o, depth), element, at, reader);
    names.push_back(output.name);
  }
  if (name == gate_name && inner.entry->condition)
    return made_wire(flat_.gates[size_t(inner.gate)].block, at);
  for (const DiagramInput& input : inner.diagram->inputs)
    if (input.name == name) return resolve_input(inner, name, element, at, reader, depth + 1);
  if (rest.find('.') != rest.npos) return resolve(inner, rest, at, reader, depth + 1);
  return fail(at, reader,
              fmt::format("the subdiagram \"{}\" has no output \"{}\"",
                          inner.prefix.substr(0, inner.prefix.size() - 1), name),
              names, name);
}

FlatWire WireResolver::output_of(Scope& inner, size_t o, int depth) {
  const DiagramOutput& output = inner.diagram->outputs[o];
  if (!inner.reset_outputs.empty()) return made_wire(inner.reset_outputs[o], output.source);
  return resolve(inner, output.source.source, output.source, inner.prefix + output.name, depth + 1);
}
FlatWire made_wire(int block, const Wire& at) {
  FlatWire wire;
  wire.block = block, wire.output = 0, wire.at = &at;
  return wire;
}

FlatWire WireResolver::resolve_port(int block, std::string_view rest, const Wire& at,
                                    const std::string& reader, int depth) {
  FlatBlock& flat = flat_.blocks[size_t(block)];
  const size_t bracket = rest.find('[');
  const std::string name(rest.substr(0, bracket)), element(bracket == rest.npos ? "" : rest.substr(bracket));
  const BlockInfo& info = flat.type->info;
  for (size_t o = 0; o < info.outputs.size(); ++o)
    if (info.outputs[o].name == name) {
      FlatWire wire;
      wire.block = block, wire.output = int(o), wire.at = &at;
      return with_element(std::move(wire), element, at, reader);
    }
  if (reader == "log")  // an input may be logged: this records its source
    for (const PortWires& wires : flat.entry->in)
      if (wires.port == name && wires.wires.size() == 1)
        return with_element(resolve(*scopes_[size_t(block)], wires.wires[0].source, at, reader, depth + 1),
                            element, at, reader);
  std::vector<std::string> names;
  for (const PortInfo& output : info.outputs) names.emplace_back(output.name);
  return fail(at, reader, fmt::format("{} \"{}\" has no output \"{}\"", info.type, flat.path, name), names,
              name);
}

FlatWire WireResolver::with_element(FlatWire wire, const std::string& element, const Wire& at,
                                    const std::string& reader) {
  if (element.empty() || !wire.is_resolved()) return wire;
  const bool is_index = element.size() >= 3 && element.size() <= 9 && element.back() == ']' &&
                        element.find_first_not_of("0123456789", 1) == element.size() - 1;
  if (!is_index) return fail(at, reader, fmt::format("\"{}\" is not an element", at.source), {}, "");
  if (wire.element >= 0)
    return fail(at, reader, fmt::format("\"{}\" is already one element", at.source), {}, "");
  wire.element = std::stoi(element.substr(1));
  return wire;
}

FlatWire WireResolver::fail(const Wire& at, const std::string& reader, std::string message,
                            std::vector<std::string> names, const std::string& wrong, std::string hint) {
  if (!told_.insert(at.place.pointer() + message).second)
    return {};  // a wire into a subdiagram may have many readers
  auto& p = problems_.error(at.place, at.place.pointer(), reader, std::move(message));
  p.found = "\"" + at.source + "\"";
  const std::string near = wrong.empty() ? "" : nearest_name(wrong, names);
  if (!hint.empty())
    p.hint = std::move(hint);
  else if (!near.empty())
    p.hint = fmt::format("did you mean \"{}\"?", near);
  else if (!names.empty() && names.size() <= 12)
    p.expected = fmt::format("one of {}", fmt::join(names, ", "));
  return {};
}

}  // namespace loopwright
