#include "blocks/logic/state_chart.h"
#include <fmt/format.h>
#include <algorithm>
#include <numeric>
#include "blocks/logic/state_machine.h"

namespace loopwright::blocks {
namespace {

int index_of(const auto& list, const std::string& name) {
  const auto found = std::ranges::find(list, name, [](const auto& entry) { return entry.name; });
  return int(found - list.begin());
}

/// The initial state among those inside `parent`, -1 for the outermost; -1: there is none.
int initial_of(const MachineSettings& settings, const std::string& parent, const std::string& initial) {
  if (!initial.empty()) return index_of(settings.states, initial);
  const auto first = std::ranges::find(settings.states, parent, &MachineState::inside);
  return first == settings.states.end() ? -1 : int(first - settings.states.begin());
}

}  // namespace

StateChart chart_of(const MachineSettings& settings) {
  StateChart chart;
  const GuardNames names = settings.guard_names();
  for (const MachineState& state : settings.states) {
    ChartState& to = chart.states.emplace_back();
    if (!state.inside.empty()) to.parent = index_of(settings.states, state.inside);
    to.initial = initial_of(settings, state.name, state.initial);
    for (const auto& [output, value] : state.set.entries)
      to.set.emplace_back(index_of(settings.declared_outputs, output), value);
  }
  for (size_t i = 0; i < chart.states.size(); ++i) {
    ChartState& state = chart.states[i];
    for (int s = int(i); s >= 0; s = chart.states[size_t(s)].parent)
      state.chain.insert(state.chain.begin(), s);
  }
  chart.add_defaults(initial_of(settings, "", settings.initial), chart.enters);
  for (size_t i = 0; i < chart.states.size(); ++i) {
    const auto& transitions = settings.states[i].transitions;
    std::vector<size_t> order(transitions.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](size_t t) { return transitions[t].priority; });
    for (const size_t t : order) {
      const int to = index_of(settings.states, transitions[t].to);
      chart.states[i].transitions.push_back(
          {to, std::make_shared<Guard>(transitions[t].when, names), chart.entered(int(i), to)});
    }
  }
  return chart;
}

FormulaUnit unit_of_guards(const MachineSettings& settings, std::span<const Unit> of_inputs) {
  FormulaUnit result;
  result.finding = UnitFinding::known;  // of the number of the state
  result.parameter = "states";
  const bool has_errors = settings.places.size() != settings.states.size();  // which were reported
  if (has_errors || of_inputs.size() != settings.inputs.size()) return result;
  const GuardNames names = settings.guard_names();
  for (size_t s = 0; s < settings.states.size(); ++s)
    for (size_t t = 0; t < settings.states[s].transitions.size(); ++t) {
      const std::string& when = settings.states[s].transitions[t].when;
      const Guard guard(when, names);
      const UnitFinding finding = guard.compare_units(of_inputs, names);
      if (finding == UnitFinding::known) continue;
      result.finding = finding;
      result.place = settings.places[s][t];
      result.found = when;
      for (size_t i = 0; i < of_inputs.size(); ++i)
        if (guard.reads(settings.inputs[i]))
          result.found += fmt::format(", {} in {}", settings.inputs[i], to_string(of_inputs[i]));
      for (const NamedNumber& constant : settings.constants)
        if (guard.reads(constant.name))
          result.found +=
              fmt::format(", {} in {}", constant.name, constant.unit.empty() ? "1" : constant.unit);
      return result;
    }
  return result;
}

}  // namespace loopwright::blocks
