#include "tools/draw/machine_chart.h"
#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <numeric>
#include "engine/json/json.h"
#include "tools/report/typography.h"

namespace loopwright {
namespace {

Value parsed(const std::string& text) {
  Problems ignored;  // the plan has read the same settings
  return text.empty() ? Value{} : parse_json(std::make_shared<SourceFile>(SourceFile{.text = text}), ignored);
}

std::string text_of(const Value& object, std::string_view key) {
  const Value::Member* const member = object.find(key);
  return member ? member->value.text : std::string();
}

const std::vector<Value>& items_of(const Value& object, std::string_view key) {
  static const std::vector<Value> none;
  const Value::Member* const member = object.find(key);
  return member ? member->value.items : none;
}

/// "velocity = 20 mm/s" for each output that the state sets.
std::vector<std::string> entries_of(const Value& state, const std::map<std::string, std::string>& units) {
  std::vector<std::string> entries;
  if (const Value::Member* const set = state.find("set"))
    for (const Value::Member& member : set->value.members) {
      const auto unit = units.find(member.name);
      const report::Quantity shown =
          report::engineering(member.value.number, unit == units.end() ? std::string() : unit->second);
      entries.push_back(
          fmt::format("{} = {}{}{}", member.name, shown.value, shown.unit.empty() ? "" : " ", shown.unit));
    }
  return entries;
}

std::map<std::string, std::string> units_of(const Value& outputs) {
  std::map<std::string, std::string> units;
  for (const Value& output : outputs.items)
    if (const auto unit = parse_unit(text_of(output, "unit")))
      units[text_of(output, "name")] = to_string(unit->in_si());
  return units;
}

/// Transitions in the order in which they are tested.
std::vector<const Value*> tested(const Value& state) {
  std::vector<const Value*> transitions;
  for (const Value& transition : items_of(state, "transitions")) transitions.push_back(&transition);
  std::ranges::stable_sort(transitions, {}, [](const Value* transition) {
    const Value::Member* const priority = transition->find("priority");
    return priority ? priority->value.number : 0.0;
  });
  return transitions;
}

void mark_initial(report::GraphChart& chart, int parent, const std::string& initial) {
  const auto is_it = [&](const report::ChartState& state) {
    return state.parent == parent && (initial.empty() || state.name == initial);
  };
  const auto found = std::ranges::find_if(chart.states, is_it);
  if (found != chart.states.end()) found->is_initial = true;
}

}  // namespace

report::GraphChart machine_chart(const std::string& states_text, const std::string& outputs,
                                 const std::string& initial) {
  const Value states = parsed(states_text);
  const auto units = units_of(parsed(outputs));
  std::map<std::string, size_t> index;
  for (const Value& state : states.items) index.emplace(text_of(state, "name"), index.size());
  report::GraphChart chart;
  for (const Value& state : states.items) {
    const auto outer = index.find(text_of(state, "inside"));
    chart.states.push_back({text_of(state, "name"), outer == index.end() ? -1 : int(outer->second), false,
                            entries_of(state, units)});
    const std::vector<const Value*> transitions = tested(state);
    for (size_t t = 0; t < transitions.size(); ++t)
      if (const auto to = index.find(text_of(*transitions[t], "to")); to != index.end())
        chart.transitions.push_back({chart.states.size() - 1, to->second, text_of(*transitions[t], "when"),
                                     transitions.size() > 1 ? int(t + 1) : 0});
  }
  mark_initial(chart, -1, initial);
  for (size_t s = 0; s < states.items.size(); ++s)
    mark_initial(chart, int(s), text_of(states.items[s], "initial"));
  return chart;
}

report::GraphChart machine_chart(const ShownSettings& settings) {
  return machine_chart(settings.text("states"), settings.text("outputs"), settings.text("initial"));
}

}  // namespace loopwright
