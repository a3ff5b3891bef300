#include "engine/plan/flatten.h"
#include <fmt/format.h>
#include <algorithm>
#include <deque>
#include <optional>
#include <unordered_set>
#include "engine/plan/block_settings.h"
#include "engine/plan/block_values.h"
#include "engine/plan/scope.h"

namespace loopwright {
namespace {

class Flattener {
 public:
  Flattener(Problems& problems, bool open) : problems_(problems), open_(open) {}

  FlatDiagram run(const Diagram& diagram) {
    flat_.blocks.reserve(diagram.blocks.size());
    flat_.settings.effective.reserve(diagram.parameters.size() + 2 * diagram.blocks.size());
    flat_.settings.add(diagram.parameters);
    Scope& top = add_scope(diagram, "", nullptr, nullptr);
    for (size_t i = 0; i < scopes_.size(); ++i) wire_blocks(scopes_[i]);  // the deque no longer grows
    for (size_t i = 0; i < scopes_.size(); ++i) check_subdiagram_wires(scopes_[i]);
    add_log(top);
    add_names();
    return std::move(flat_);
  }

 private:
  Scope& add_scope(const Diagram& diagram, std::string prefix, const BlockEntry* entry, Scope* parent) {
    Scope& scope = scopes_.emplace_back(Scope{&diagram, std::move(prefix), entry, parent});
    scope.parts.reserve(diagram.blocks.size());
    for (const BlockEntry& block : diagram.blocks) {
      scope.blocks.add(scope.parts.size());
      Scope::Part part;
      if (block.subdiagram)
        part.inner = &add_scope(*block.subdiagram, scope.prefix + block.name + ".", &block, &scope);
      else if (!block.type.empty())  // otherwise reported when it was loaded
        part.flat_block = add_block(scope, block);
      scope.parts.push_back(part);
    }
    return scope;
  }

  /// Its index in the flat list; -1 after a problem.
  int add_block(Scope& scope, const BlockEntry& entry) {
    FlatBlock flat{.path = scope.prefix + entry.name,
                   .entry = &entry,
                   .type = find_block(entry.type),
                   .value = {},
                   .inputs = FlatInputs(flat_.memory.get()),
                   .output_lengths = std::pmr::vector<int>(flat_.memory.get())};
    if (!flat.type) {
      unknown_type(flat.path, entry);
      return -1;
    }
    const Value& settings = settings_of(*scope.diagram, *flat.type, entry);
    const auto by_element = settings_by_element(flat.type->info, settings, flat.path, problems_);
    if (by_element.size() < 2) {
      flat.value = read_value(*flat.type, by_element.empty() ? settings : by_element[0], flat.path);
    } else {
      const size_t before = errors();
      for (const Value& element : by_element) {
        flat.elements.push_back(read_value(*flat.type, element, flat.path));
        if (errors() > before) break;  // the others have the same problems
      }
      flat.value = flat.elements[0];
    }
    flat_.settings.add(int(flat_.blocks.size()), *flat.type, settings, flat.path);
    flat.inputs.resize(flat.type->info.inputs.size());
    flat.output_lengths.assign(flat.type->info.outputs.size(), 1);
    flat_.blocks.push_back(std::move(flat));
    scope_of_block_.push_back(&scope);
    return int(flat_.blocks.size()) - 1;
  }

  /// As in the file, or with the parameters of the diagram that its formula names.
  const Value& settings_of(const Diagram& diagram, const BlockType& type, const BlockEntry& entry) {
    auto extended = settings_with_constants(type.info, entry.settings, diagram.parameters);
    return extended ? flat_.extended_settings.emplace_back(std::move(*extended)) : entry.settings;
  }

  std::shared_ptr<void> read_value(const BlockType& type, const Value& settings, const std::string& path) {
    std::shared_ptr<void> value(values_, values_->add(type.kernels));
    const size_t before = errors();
    type.info.read(value.get(), settings, path, problems_);
    if (errors() == before) type.info.check(value.get(), Checker(settings, path, problems_));
    return value;
  }

  /// The number of errors so far. Each problem is looked at once: a large diagram can have many warnings.
  size_t errors() {
    const auto& list = problems_.list();
    for (; looked_at_ < list.size(); ++looked_at_)
      errors_ += list[looked_at_].severity == Problem::Severity::error;
    return errors_;
  }

  void unknown_type(const std::string& path, const BlockEntry& entry) {
    problems_
        .error(entry.type_place, entry.place.pointer() + "/type", path,
               fmt::format("there is no block type \"{}\"", entry.type))
        .hint = block_type_hint(entry.type);
  }

  void wire_blocks(Scope& scope) {
    for (const Scope::Part& part : scope.parts)
      if (part.flat_block >= 0) wire_block(scope, flat_.blocks[size_t(part.flat_block)]);
  }

  void wire_block(Scope& scope, FlatBlock& flat) {
    const BlockInfo& info = flat.type->info;
    for (const PortWires& wires : flat.entry->in) {
      const auto port = std::ranges::find(info.inputs, wires.port, &PortInfo::name);
      if (port == info.inputs.end()) {
        unknown_input(flat, wires, info);
        continue;
      }
      if (port->shape != PortInfo::Shape::many && wires.wires.size() != 1) {
        auto& p = problems_.error(wires.place, wires.place.pointer(), flat.path,
                                  fmt::format("the input \"{}\" takes one wire", wires.port));
        p.expected = "one source, as in \"stage.position\"";
        p.found = fmt::format("a list of {}", wires.wires.size());
        continue;
      }
      auto& sources = flat.inputs[size_t(port - info.inputs.begin())];
      sources.reserve(sources.size() + wires.wires.size());
      for (const Wire& wire : wires.wires) sources.push_back(resolve(scope, wire.source, wire, flat.path, 0));
    }
    for (size_t i = 0; i < info.inputs.size(); ++i) {
      const bool listed = std::ranges::any_of(
          flat.entry->in, [&](const PortWires& w) { return w.port == info.inputs[i].name; });
      if (listed || info.inputs[i].is_optional) continue;
      auto& p = problems_.error(flat.entry->place, flat.entry->place.pointer(), flat.path,
                                fmt::format("the input \"{}\" is not wired", info.inputs[i].name));
      p.expected = fmt::format("\"in\": {{\"{}\": \"block.output\"}}", info.inputs[i].name);
      p.hint = info.inputs[i].sentence;
    }
  }

  void unknown_input(const FlatBlock& flat, const PortWires& wires, const BlockInfo& info) {
    std::vector<std::string> names;
    for (const PortInfo& port : info.inputs) names.emplace_back(port.name);
    auto& p = problems_.error(wires.place, wires.place.pointer(), flat.path,
                              fmt::format("{} has no input \"{}\"", info.type, wires.port));
    const std::string near = nearest_name(wires.port, names);
    p.expected = names.empty() ? "no inputs" : fmt::format("{}", fmt::join(names, ", "));
    if (!near.empty()) p.hint = fmt::format("did you mean \"{}\"?", near);
  }

  /// Follows a name to its block output, through diagram inputs, subdiagram outputs and nested paths.
  FlatWire resolve(Scope& scope, std::string_view text, const Wire& at, const std::string& reader,
                   int depth) {
    if (depth > 200)
      return fail(at, reader, "the wire leads round in a circle of subdiagram outputs", {}, "");
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

  static FlatWire unresolved(const Wire& at) {
    FlatWire wire;
    wire.at = &at;
    return wire;
  }

  FlatWire resolve_input(Scope& scope, const std::string& name, const std::string& element, const Wire& at,
                         const std::string& reader, int depth) {
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

  FlatWire resolve_inside(Scope& inner, std::string_view rest, const Wire& at, const std::string& reader,
                          int depth) {
    const size_t bracket = rest.find('[');
    const std::string name(rest.substr(0, bracket)),
        element(bracket == rest.npos ? "" : rest.substr(bracket));
    std::vector<std::string> names;
    for (const DiagramOutput& output : inner.diagram->outputs) {
      if (output.name == name)
        return with_element(
            resolve(inner, output.source.source, output.source, inner.prefix + name, depth + 1), element, at,
            reader);
      names.push_back(output.name);
    }
    for (const DiagramInput& input : inner.diagram->inputs)
      if (input.name == name) return resolve_input(inner, name, element, at, reader, depth + 1);
    if (rest.find('.') != rest.npos) return resolve(inner, rest, at, reader, depth + 1);
    return fail(at, reader,
                fmt::format("the subdiagram \"{}\" has no output \"{}\"",
                            inner.prefix.substr(0, inner.prefix.size() - 1), name),
                names, name);
  }

  FlatWire resolve_port(int block, std::string_view rest, const Wire& at, const std::string& reader,
                        int depth) {
    FlatBlock& flat = flat_.blocks[size_t(block)];
    const size_t bracket = rest.find('[');
    const std::string name(rest.substr(0, bracket)),
        element(bracket == rest.npos ? "" : rest.substr(bracket));
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
          return with_element(
              resolve(*scope_of_block_[size_t(block)], wires.wires[0].source, at, reader, depth + 1), element,
              at, reader);
    std::vector<std::string> names;
    for (const PortInfo& output : info.outputs) names.emplace_back(output.name);
    return fail(at, reader, fmt::format("{} \"{}\" has no output \"{}\"", info.type, flat.path, name), names,
                name);
  }

  FlatWire with_element(FlatWire wire, const std::string& element, const Wire& at,
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

  FlatWire fail(const Wire& at, const std::string& reader, std::string message,
                std::vector<std::string> names, const std::string& wrong, std::string hint = "") {
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

  /// Checks the wires into a subdiagram: one for every input, and none to an input that does not exist.
  void check_subdiagram_wires(Scope& scope) {
    if (!scope.entry) return;
    const std::string path = scope.prefix.substr(0, scope.prefix.size() - 1);
    std::vector<std::string> names;
    for (const DiagramInput& input : scope.diagram->inputs) {
      names.push_back(input.name);
      if (std::ranges::any_of(scope.entry->in, [&](const PortWires& w) { return w.port == input.name; }))
        continue;
      auto& p = problems_.error(scope.entry->place, scope.entry->place.pointer(), path,
                                fmt::format("the input \"{}\" is not wired", input.name));
      p.expected = fmt::format("\"in\": {{\"{}\": \"block.output\"}}", input.name);
    }
    for (const PortWires& wires : scope.entry->in) {
      if (std::ranges::find(names, wires.port) == names.end()) {
        auto& p = problems_.error(wires.place, wires.place.pointer(), path,
                                  fmt::format("the subdiagram has no input \"{}\"", wires.port));
        const std::string near = nearest_name(wires.port, names);
        p.expected = names.empty() ? "no inputs" : fmt::format("{}", fmt::join(names, ", "));
        if (!near.empty()) p.hint = fmt::format("did you mean \"{}\"?", near);
      } else if (wires.wires.size() != 1) {
        problems_
            .error(wires.place, wires.place.pointer(), path,
                   fmt::format("the input \"{}\" takes one wire", wires.port))
            .found = fmt::format("a list of {}", wires.wires.size());
      } else {
        for (const Wire& wire : wires.wires) resolve(*scope.parent, wire.source, wire, path, 0);
      }
    }
    for (const DiagramOutput& output : scope.diagram->outputs)
      resolve(scope, output.source.source, output.source, scope.prefix + output.name, 0);
  }

  void add_log(Scope& top) {
    for (const Wire& wire : top.diagram->log) {
      if (wire.source.ends_with(".*")) {
        const std::string prefix = wire.source.substr(0, wire.source.size() - 1);
        bool any = false;
        for (size_t b = 0; b < flat_.blocks.size(); ++b) {
          const FlatBlock& block = flat_.blocks[b];
          if (!(block.path + ".").starts_with(prefix)) continue;
          for (size_t o = 0; o < block.type->info.outputs.size(); ++o) {
            any = true;
            FlatWire source;
            source.block = int(b), source.output = int(o), source.at = &wire;
            flat_.log.push_back({fmt::format("{}.{}", block.path, block.type->info.outputs[o].name), source});
          }
        }
        if (!any) fail(wire, "log", fmt::format("nothing matches \"{}\"", wire.source), {}, "");
      } else {
        flat_.log.push_back({wire.source, resolve(top, wire.source, wire, "log", 0)});
      }
    }
  }

  /// Outputs and inputs of subdiagrams by full path.
  void add_names() {
    Problems unheard;  // already reported
    std::swap(unheard, problems_);
    for (Scope& scope : scopes_) {
      auto& outputs = scope.entry ? flat_.names : flat_.outputs;
      for (const DiagramOutput& output : scope.diagram->outputs)
        outputs.push_back(
            {scope.prefix + output.name, resolve(scope, output.source.source, output.source, "", 0)});
      if (!scope.entry) continue;
      for (const DiagramInput& input : scope.diagram->inputs)
        flat_.names.push_back(
            {scope.prefix + input.name, resolve_input(scope, input.name, "", Wire{input.name, {}}, "", 0)});
    }
    std::swap(unheard, problems_);
  }

  Problems& problems_;
  size_t looked_at_ = 0, errors_ = 0;  // of the problems
  const bool open_;
  FlatDiagram flat_;
  std::shared_ptr<BlockValues> values_ = std::make_shared<BlockValues>();
  std::deque<Scope> scopes_;
  std::vector<Scope*> scope_of_block_;
  std::unordered_set<std::string> told_;
};

}  // namespace

FlatDiagram flatten(const Diagram& diagram, Problems& problems, bool open) {
  return Flattener(problems, open).run(diagram);
}

}  // namespace loopwright
