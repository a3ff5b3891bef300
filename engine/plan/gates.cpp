#include "engine/plan/gates.h"
#include <fmt/format.h>
#include <algorithm>
#include "engine/plan/plan.h"

namespace loopwright {
namespace {

/// The rate of the Enable block.
Rate rate_of(const Plan& plan, const Plan::Gate& gate) {
  const auto entry = std::ranges::find_if(plan.order, [&](const Plan::Entry& e) {
    return e.kind == Plan::Entry::Kind::decide && e.block == gate.block;
  });
  return entry == plan.order.end() ? Rate{} : entry->rate;
}

Problem& refuse(const Plan::Block& block, std::string message, Problems& problems) {
  return problems.error(block.place, block.place.pointer(), block.path, std::move(message));
}

void check_block(const Plan& plan, const Plan::Block& block, Problems& problems) {
  const Plan::Gate& gate = plan.gates[size_t(block.gate)];
  const BlockInfo& info = block.type->info;
  if (info.has_side_effects)
    refuse(block, fmt::format("{} acts on the outside world: it cannot stop and start again", info.type),
           problems)
        .hint = "place it outside the subdiagram, and wire it to an output of the subdiagram";
  if (block.type->kernels.accept)
    refuse(block, fmt::format("{} stores the past of its input: it cannot stop and start again", info.type),
           problems)
        .hint = "place it outside the subdiagram, or use a sampled block";
  if (!gate.is_triggered) return;
  if (block.type->kernels.derivatives)
    refuse(block,
           fmt::format("{} is continuous: it has no meaning in a subdiagram that is triggered", info.type),
           problems)
        .hint = "use a sampled block, or \"enabled_by\"";
  const Rate rate = rate_of(plan, gate);
  if (block.period == 0 || rate.kind != Rate::Kind::sampled) return;
  if (block.period == rate.period && block.offset == rate.offset) return;
  auto& p =
      refuse(block, fmt::format("{} would miss triggers: it is sampled at other times", info.type), problems);
  p.expected =
      fmt::format("the sample time of the trigger, {:g} s{}", plan.clock.time(rate.period),
                  rate.offset ? fmt::format(" with an offset of {:g} s", plan.clock.time(rate.offset)) : "");
  p.found = fmt::format(
      "{:g} s{}", block.sample_time,
      block.offset ? fmt::format(" with an offset of {:g} s", plan.clock.time(block.offset)) : "");
}

}  // namespace

BlockEntry entry_of_gate(const BlockEntry& subdiagram, std::string_view type) {
  const RunCondition& condition = *subdiagram.condition;
  BlockEntry entry;
  entry.place = entry.type_place = condition.place;
  entry.type = type;
  entry.settings.kind = Value::Kind::object;
  entry.settings.place = condition.place;
  if (type != "Enable") return entry;
  Value kind;
  kind.kind = Value::Kind::text;
  kind.text = condition.kind;
  kind.place = condition.place;
  entry.settings.members.push_back({"kind", condition.place, std::move(kind)});
  return entry;
}

bool is_inside(const FlatDiagram& flat, int gate, int outer) {
  while (gate >= 0 && gate != outer) gate = flat.gates[size_t(gate)].parent;
  return gate == outer;
}

void check_gate_names(const BlockEntry& subdiagram, const std::string& path, Problems& problems) {
  const auto refuse_name = [&](const auto& named) {
    if (named.name == gate_name)
      problems
          .error(named.place, named.place.pointer(), path,
                 fmt::format("the name \"{}\" is in use: {}.{} is 1 while the subdiagram runs", gate_name,
                             path, gate_name))
          .expected = "another name";
  };
  for (const BlockEntry& block : subdiagram.subdiagram->blocks) refuse_name(block);
  for (const DiagramInput& input : subdiagram.subdiagram->inputs) refuse_name(input);
  for (const DiagramOutput& output : subdiagram.subdiagram->outputs) refuse_name(output);
}

void check_held_output(const FlatDiagram& flat, int gate, const DiagramOutput& output, const FlatWire& source,
                       const std::string& path, Problems& problems) {
  if (!source.is_resolved() || is_inside(flat, flat.blocks[size_t(source.block)].gate, gate)) return;
  problems
      .error(
          output.place, output.place.pointer(), path,
          fmt::format("the output \"{}\" is wired straight to an input: it would not be held", output.name))
      .hint = "a Gain of 1 between them holds it";
}

void add_gates(const FlatDiagram& flat, const std::vector<int>& flat_of_block, Plan& plan,
               Problems& problems) {
  if (flat.gates.empty()) return;
  std::vector<int> first_instance(flat.blocks.size(), -1);
  for (size_t b = plan.blocks.size(); b-- > 0;)
    if (flat_of_block[b] >= 0) {
      first_instance[size_t(flat_of_block[b])] = int(b);
      plan.blocks[b].gate = flat.blocks[size_t(flat_of_block[b])].gate;
    }
  for (const FlatGate& flat_gate : flat.gates) {
    Plan::Gate& gate = plan.gates.emplace_back();
    gate.block = first_instance[size_t(flat_gate.block)];
    gate.on = plan.blocks[size_t(gate.block)].outputs[0];
    gate.parent = flat_gate.parent;
    gate.is_triggered = flat_gate.is_triggered;
    gate.is_edge = flat_gate.entry->condition->is_triggered();
    gate.key = flat_gate.entry->condition->key;
    gate.place = flat_gate.entry->condition->place;
    if (const int width = flat.blocks[size_t(flat_gate.block)].width; width != 1) {
      const Wire& wire = flat_gate.entry->condition->wire;
      auto& p = problems.error(wire.place, wire.place.pointer(), flat.blocks[size_t(flat_gate.block)].path,
                               fmt::format("\"{}\" takes one logic value", gate.key));
      p.expected = "a scalar; an element is written \"block.port[0]\"";
      p.found = fmt::format("\"{}\" with {} elements", wire.source, width);
    }
  }
  for (size_t g = 0; g < flat.gates.size(); ++g) {
    if (!flat.gates[g].entry->condition->resets_states) continue;
    for (size_t b = 0; b < plan.blocks.size(); ++b)
      if (is_inside(flat, plan.blocks[b].gate, int(g))) plan.gates[g].restarts.push_back(int(b));
  }
}

void check_gates(const Plan& plan, Problems& problems) {
  for (const Plan::Gate& gate : plan.gates) {
    if (!gate.is_edge || rate_of(plan, gate).kind != Rate::Kind::continuous) continue;
    auto& p = problems.error(gate.place, gate.place.pointer(), plan.blocks[size_t(gate.block)].path,
                             "a trigger must be a sampled signal");
    p.found = "a signal that may change at any time";
    p.hint = "an Edge or ZeroOrderHold with a \"sample_time\" samples it";
  }
  for (const Plan::Block& block : plan.blocks)
    if (block.gate >= 0) check_block(plan, block, problems);
}

}  // namespace loopwright
