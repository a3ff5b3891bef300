#include "engine/plan/flatten.h"
#include <fmt/format.h>
#include <algorithm>
#include <deque>
#include <optional>
#include "engine/plan/block_settings.h"
#include "engine/plan/block_values.h"
#include "engine/plan/gates.h"
#include "engine/plan/wire_resolver.h"

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
    for (size_t i = 0; i < scopes_.size(); ++i) make_gate(scopes_[i]);
    for (size_t i = 0; i < scopes_.size(); ++i) wire_blocks(scopes_[i]);  // the deque no longer grows
    for (size_t i = 0; i < scopes_.size(); ++i) check_subdiagram_wires(scopes_[i]);
    for (size_t i = 0; i < scopes_.size(); ++i) wire_gate(scopes_[i]);
    add_log(top);
    add_names();
    return std::move(flat_);
  }

 private:
  Scope& add_scope(const Diagram& diagram, std::string prefix, const BlockEntry* entry, Scope* parent) {
    Scope& scope = scopes_.emplace_back(Scope{&diagram, std::move(prefix), entry, parent});
    if (parent) scope.gate = parent->gate;
    if (entry && entry->condition) {
      flat_.gates.push_back({-1, scope.gate, entry, entry->condition->is_triggered()});
      if (scope.gate >= 0) flat_.gates.back().is_triggered |= flat_.gates[size_t(scope.gate)].is_triggered;
      scope.gate = int(flat_.gates.size()) - 1;
    }
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
    flat.gate = scope.gate;
    const Value& settings = settings_of(*scope.diagram, *flat.type, entry, flat.path);
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
    if (auto own = instance_type(*flat.type, flat.value.get()))
      flat.type = flat_.instance_types.emplace_back(std::move(own)).get();
    flat_.settings.add(int(flat_.blocks.size()), *flat.type, settings, flat.path);
    flat.inputs.resize(flat.type->info.inputs.size());
    flat.output_lengths.assign(flat.type->info.outputs.size(), 1);
    flat_.blocks.push_back(std::move(flat));
    scope_of_block_.push_back(&scope);
    return int(flat_.blocks.size()) - 1;
  }

  /// The Enable block of a subdiagram, and the blocks of outputs that are reset.
  void make_gate(Scope& scope) {
    if (!scope.entry || !scope.entry->condition) return;
    check_gate_names(*scope.entry, scope.prefix.substr(0, scope.prefix.size() - 1), problems_);
    flat_.gates[size_t(scope.gate)].block = make_block(scope, "Enable", gate_name);
    if (scope.entry->condition->resets_outputs)
      for (const DiagramOutput& output : scope.diagram->outputs)
        scope.reset_outputs.push_back(make_block(scope, "EnabledOutput", output.name));
  }
  int make_block(Scope& inner, std::string_view type, std::string_view name) {
    BlockEntry& entry = flat_.made_entries.emplace_back(entry_of_gate(*inner.entry, type));
    entry.name = inner.entry->name + "." + std::string(name);
    return add_block(*inner.parent, entry);
  }
  void wire_gate(Scope& scope) {
    if (!scope.entry || !scope.entry->condition) return;
    const RunCondition& condition = *scope.entry->condition;
    const FlatGate& gate = flat_.gates[size_t(scope.gate)];
    if (gate.block < 0) return;
    const std::string path = scope.prefix.substr(0, scope.prefix.size() - 1);
    FlatBlock& enable = flat_.blocks[size_t(gate.block)];
    enable.inputs[0].push_back(wires_.resolve(*scope.parent, condition.wire.source, condition.wire, path, 0));
    for (size_t o = 0; o < scope.diagram->outputs.size(); ++o) {
      const DiagramOutput& output = scope.diagram->outputs[o];
      const FlatWire source =
          wires_.resolve(scope, output.source.source, output.source, scope.prefix + output.name, 0);
      if (scope.reset_outputs.empty()) {
        check_held_output(flat_, scope.gate, output, source, path, problems_);
        continue;
      }
      FlatBlock& block = flat_.blocks[size_t(scope.reset_outputs[o])];
      block.inputs[0].push_back(source);
      block.inputs[1].push_back(made_wire(gate.block, condition.wire));
    }
  }

  /// As in the file, or with matrices in the forms that the block takes and the parameters of the diagram
  /// that its formula names.
  const Value& settings_of(const Diagram& diagram, const BlockType& type, const BlockEntry& entry,
                           const std::string& path) {
    const Value* settings = &entry.settings;
    if (auto formed = settings_in_form(type.info, *settings, {problems_, path}))
      settings = &flat_.extended_settings.emplace_back(std::move(*formed));
    if (auto extended = settings_with_constants(type.info, *settings, diagram.parameters))
      settings = &flat_.extended_settings.emplace_back(std::move(*extended));
    return *settings;
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
      for (const Wire& wire : wires.wires)
        sources.push_back(wires_.resolve(scope, wire.source, wire, flat.path, 0));
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
        for (const Wire& wire : wires.wires) wires_.resolve(*scope.parent, wire.source, wire, path, 0);
      }
    }
    for (const DiagramOutput& output : scope.diagram->outputs)
      wires_.resolve(scope, output.source.source, output.source, scope.prefix + output.name, 0);
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
        if (!any) wires_.fail(wire, "log", fmt::format("nothing matches \"{}\"", wire.source), {}, "");
      } else {
        flat_.log.push_back({wire.source, wires_.resolve(top, wire.source, wire, "log", 0)});
      }
    }
  }

  /// Outputs and inputs of subdiagrams by full path.
  void add_names() {
    Problems unheard;  // already reported
    std::swap(unheard, problems_);
    for (Scope& scope : scopes_) {
      auto& outputs = scope.entry ? flat_.names : flat_.outputs;
      for (size_t o = 0; o < scope.diagram->outputs.size(); ++o)
        outputs.push_back({scope.prefix + scope.diagram->outputs[o].name, wires_.output_of(scope, o, 0)});
      if (!scope.entry) continue;
      if (scope.entry->condition)
        flat_.names.push_back(
            {scope.prefix + std::string(gate_name),
             made_wire(flat_.gates[size_t(scope.gate)].block, scope.entry->condition->wire)});
      for (const DiagramInput& input : scope.diagram->inputs)
        flat_.names.push_back({scope.prefix + input.name,
                               wires_.resolve_input(scope, input.name, "", Wire{input.name, {}}, "", 0)});
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
  WireResolver wires_{flat_, scope_of_block_, open_, problems_};
};

}  // namespace

FlatDiagram flatten(const Diagram& diagram, Problems& problems, bool open) {
  return Flattener(problems, open).run(diagram);
}

}  // namespace loopwright
