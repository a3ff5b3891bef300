#include "engine/diagram/run_condition.h"
#include <algorithm>
#include <array>
#include <fmt/format.h>
#include "engine/diagram/wires.h"

namespace loopwright {
namespace {

/// Whether "hold" or "reset" is written; `otherwise` without a value, and after a problem.
bool is_reset(const Value::Member* member, bool otherwise, const Reader& reader) {
  if (!member) return otherwise;
  const Value& value = member->value;
  if (value.kind == Value::Kind::text && (value.text == "hold" || value.text == "reset"))
    return value.text == "reset";
  Problem& problem = reader.error(value, fmt::format("\"{}\" is neither held nor reset", member->name));
  problem.expected = "\"hold\" or \"reset\"";
  problem.found = shown(value);
  return otherwise;
}

void read_while_disabled(const Value::Member& member, RunCondition& condition, const Reader& reader) {
  if (member.value.kind != Value::Kind::object) {
    condition.resets_states = condition.resets_outputs = is_reset(&member, false, reader);
    return;
  }
  reader.reject_unknown(member.value, {"states", "outputs"}, "\"while_disabled\"");
  condition.resets_states = is_reset(member.value.find("states"), false, reader);
  condition.resets_outputs = is_reset(member.value.find("outputs"), false, reader);
}

void read_edge(const Value& value, RunCondition& condition, const Reader& reader) {
  constexpr std::array<std::string_view, 3> edges = {"rising", "falling", "either"};
  if (value.kind == Value::Kind::text && std::ranges::find(edges, value.text) != edges.end()) {
    condition.kind = value.text;
    return;
  }
  Problem& problem = reader.error(value, "there is no such edge");
  problem.expected = "\"rising\", \"falling\" or \"either\"";
  problem.found = shown(value);
}

}  // namespace

std::shared_ptr<const RunCondition> read_run_condition(const Value& body, const Reader& reader) {
  const Value::Member *enabled = body.find("enabled_by"), *triggered = body.find("triggered_by"),
                      *edge = body.find("edge"), *disabled = body.find("while_disabled");
  if (enabled && triggered) {
    reader.error(*triggered, "a subdiagram is either enabled or triggered").hint =
        "a subdiagram that is enabled may contain one that is triggered";
    return nullptr;
  }
  if (edge && !triggered)
    reader.error(*edge, "\"edge\" belongs to \"triggered_by\"").hint =
        "\"enabled_by\" lasts as long as its signal is true";
  if (disabled && !enabled)
    reader.error(*disabled, "\"while_disabled\" belongs to \"enabled_by\"").hint =
        "between two triggers, states and outputs are held";
  if (!enabled && !triggered) return nullptr;
  const Value::Member& written = enabled ? *enabled : *triggered;
  auto condition = std::make_shared<RunCondition>();
  condition->key = written.name;
  condition->place = written.place;
  condition->wire = read_wire(written.value, fmt::format("\"{}\"", written.name), reader);
  if (condition->wire.source.empty()) return nullptr;
  if (triggered) condition->kind = "rising";
  if (triggered && edge) read_edge(edge->value, *condition, reader);
  if (enabled && disabled) read_while_disabled(*disabled, *condition, reader);
  return condition;
}

}  // namespace loopwright
