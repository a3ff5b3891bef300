#include <fmt/format.h>
#include <algorithm>
#include <numeric>
#include <set>
#include "blocks/logic/state_machine.h"
#include "engine/diagram/expression.h"
#include "engine/json/reader.h"

namespace loopwright::blocks {
namespace {

class MachineCheck {
 public:
  MachineCheck(MachineSettings& machine, const Checker& checker) : machine_(machine), checker_(checker) {}

  void run() {
    if (machine_.states.empty()) {
      checker_.error("states", "a state machine has at least one state").expected =
          "[{\"name\": \"idle\"}, …]";
      return;
    }
    for (const MachineState& state : machine_.states) states_.push_back(state.name);
    for (const MachineOutput& output : machine_.declared_outputs) outputs_.push_back(output.name);
    check_names(states_, "states", "a state", {});
    check_names(machine_.inputs, "inputs", "an input", {});
    check_names(outputs_, "outputs", "an output", machine_.inputs);
    check_output_units();
    constexpr size_t most_inputs = 64;  // bits of a mask of inputs
    if (machine_.inputs.size() > most_inputs)
      checker_.error("inputs", "there are too many inputs").expected = fmt::format("at most {}", most_inputs);
    check_nesting();
    for (size_t s = 0; s < states_.size(); ++s) check_state(s);
    if (failed()) {
      machine_.places.clear();
      return;
    }
    chart_ = chart_of(machine_);
    warn_of_transitions();
    warn_of_states();
    warn_of_ports();
  }

 private:
  // ---- Places ----

  const Value& value_of(size_t state) const { return checker_.settings().find("states")->value.items[state]; }
  const Value& value_of(size_t state, std::string_view key) const {
    const Value::Member* const member = value_of(state).find(key);
    return member ? member->value : value_of(state);
  }
  const Value& value_of(size_t state, size_t transition, std::string_view key) const {
    const Value& value = value_of(state, "transitions").items[transition];
    const Value::Member* const member = value.find(key);
    return member ? member->value : value;
  }
  Problem& error(const Value& at, std::string message) {
    return checker_.problems().error(at.place, at.place.pointer(), checker_.block(), std::move(message));
  }
  Problem& warning(const Value& at, std::string message) {
    return checker_.problems().warning(at.place, at.place.pointer(), checker_.block(), std::move(message));
  }
  bool failed() const { return checker_.problems().has_errors(); }

  // ---- Errors ----

  void check_names(const std::vector<std::string>& names, std::string_view key, std::string_view what,
                   const std::vector<std::string>& others) {
    for (size_t i = 0; i < names.size(); ++i) {
      const Value& item = checker_.settings().find(key)->value.items[i];
      const Value::Member* const member = item.find("name");
      const Value& at = member ? member->value : item;
      const bool is_state = key == "states";
      if (!is_name(names[i])) {
        Problem& problem = error(at, fmt::format("this cannot be the name of {}", what));
        problem.expected = "letters, digits and _, not starting with a digit";
        problem.found = fmt::format("\"{}\"", names[i]);
      } else if (std::find(names.begin(), names.begin() + ptrdiff_t(i), names[i]) !=
                 names.begin() + ptrdiff_t(i)) {
        error(at, "the name is used twice").found = fmt::format("\"{}\"", names[i]);
      } else if (!is_state && (names[i] == "state" || std::ranges::find(others, names[i]) != others.end())) {
        error(at, "the name is already in use").found = fmt::format("\"{}\"", names[i]);
      } else if (key == "inputs" && (is_constant_name(names[i]) || names[i].starts_with('_'))) {
        error(at, "a guard cannot name this input").found = fmt::format("\"{}\"", names[i]);
      }
    }
  }
  void check_output_units() {
    for (size_t o = 0; o < machine_.declared_outputs.size(); ++o)
      if (const std::string& unit = machine_.declared_outputs[o].unit; !unit.empty() && !parse_unit(unit)) {
        const Value& item = checker_.settings().find("outputs")->value.items[o];
        error(item.find("unit")->value, "there is no such unit").found = fmt::format("\"{}\"", unit);
      }
  }
  /// A number without unit is in SI, as it is wherever the run reads it. For an output in mm it would be
  /// taken for millimetres and be metres: 0 alone is the same in both.
  void check_unit(const std::string& output, const Value& number) {
    const auto declared = std::ranges::find(machine_.declared_outputs, output, &MachineOutput::name);
    if (declared == machine_.declared_outputs.end() || number.unit) return;
    const auto unit = parse_unit(declared->unit);
    if (!unit || unit->to_si(number.number) == number.number) return;
    Problem& problem = error(
        number,
        fmt::format("a number for the output \"{}\" needs a unit, as it is in {}", output, declared->unit));
    problem.expected = fmt::format("{{\"value\": {}, \"unit\": \"{}\"}}", reading::number_text(number.number),
                                   declared->unit);
    problem.found = reading::number_text(number.number) + (number.text.empty() ? "" : " from " + number.text);
    problem.hint = fmt::format("or give the output the unit {}", to_string(unit->in_si()));
  }
  /// Reports a name of a state that does not exist.
  bool is_state(const std::string& name, const Value& at) {
    if (std::ranges::find(states_, name) != states_.end()) return true;
    KnownNames(states_).explain(error(at, fmt::format("there is no state \"{}\"", name)), name);
    return false;
  }
  size_t index_of(const std::string& name) const {
    return size_t(std::ranges::find(states_, name) - states_.begin());
  }
  void check_initial(const std::string& initial, const std::string& outer, const Value& at) {
    if (initial.empty() || !is_state(initial, at)) return;
    if (machine_.states[index_of(initial)].inside == outer) return;
    Problem& problem = error(at, fmt::format("the initial state \"{}\" is not directly inside{}", initial,
                                             outer.empty() ? " the machine" : fmt::format(" \"{}\"", outer)));
    problem.hint = "each state that contains others has an \"initial\" of its own";
  }
  void check_nesting() {
    if (!machine_.initial.empty())
      check_initial(machine_.initial, "", checker_.settings().find("initial")->value);
    for (size_t s = 0; s < states_.size(); ++s) {
      const MachineState& state = machine_.states[s];
      if (!state.inside.empty() && !is_state(state.inside, value_of(s, "inside"))) return;
    }
    for (size_t s = 0; s < states_.size(); ++s) {
      const MachineState& state = machine_.states[s];
      check_initial(state.initial, state.name, value_of(s, "initial"));
      size_t depth = 0;
      for (std::string outer = state.inside; !outer.empty() && depth <= states_.size(); ++depth)
        outer = machine_.states[index_of(outer)].inside;
      if (depth <= states_.size()) continue;
      error(value_of(s, "inside"), "states lie inside each other in a circle").found =
          fmt::format("\"{}\" inside \"{}\"", state.name, state.inside);
      return;
    }
    const bool has_outermost =
        std::ranges::any_of(machine_.states, [](const MachineState& s) { return s.inside.empty(); });
    if (!has_outermost) error(value_of(0), "every state is inside another");
  }
  void check_set(size_t s) {
    for (const auto& [output, value] : machine_.states[s].set.entries) {
      const Value& at = value_of(s, "set").find(output)->value;
      check_unit(output, at);
      if (std::ranges::find(outputs_, output) == outputs_.end())
        KnownNames(outputs_).explain(error(at, fmt::format("the state machine has no output \"{}\"", output)),
                                     output);
    }
  }
  void check_state(size_t s) {
    const MachineState& state = machine_.states[s];
    check_set(s);
    std::vector<Place> places;
    for (size_t t = 0; t < state.transitions.size(); ++t) {
      is_state(state.transitions[t].to, value_of(s, t, "to"));
      places.push_back(value_of(s, t, "when").place);
      check_guard(s, t);
    }
    check_priorities(s);
    machine_.places.push_back(std::move(places));
  }
  void check_guard(size_t s, size_t t) {
    try {
      const Guard guard(machine_.states[s].transitions[t].when, machine_.guard_names());
    } catch (const GuardError& wrong) {
      const Value& at = value_of(s, t, "when");
      Problem& problem = error(at, wrong.message);
      problem.place.offset += 1 + uint32_t(wrong.offset);  // after the quote
      problem.found = wrong.found;
      problem.hint = wrong.hint;
    }
  }
  /// Either no transition of a state has a priority, or all have different ones.
  void check_priorities(size_t s) {
    const auto& transitions = machine_.states[s].transitions;
    const bool has_any = std::ranges::any_of(transitions, [](const auto& t) { return t.priority > 0; });
    for (size_t t = 0; has_any && t < transitions.size(); ++t) {
      if (transitions[t].priority == 0) {
        Problem& problem = error(value_of(s, t, "priority"),
                                 "a transition has no priority, and others of its state have one");
        problem.expected = "a priority for each of them, or for none";
        continue;
      }
      for (size_t before = 0; before < t; ++before)
        if (transitions[before].priority == transitions[t].priority) {
          Problem& problem =
              error(value_of(s, t, "priority"),
                    fmt::format("two transitions of \"{}\" have the same priority, to \"{}\" and to \"{}\"",
                                states_[s], transitions[before].to, transitions[t].to));
          problem.expected = "a priority of its own; 1 is tested first";
          problem.found = fmt::format("{}", transitions[t].priority);
          break;
        }
    }
  }

  // ---- Warnings ----

  enum class Truth { never, always, at_times };
  static Truth truth_of(const Guard& guard) {
    if (!guard.is_constant()) return Truth::at_times;
    return guard.value(1, 1) > 0.5 ? Truth::always : Truth::never;
  }
  /// In the order of the chart; the transition of the settings.
  size_t written(size_t s, size_t sorted) const {
    const auto& transitions = machine_.states[s].transitions;
    std::vector<size_t> order(transitions.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](size_t t) { return transitions[t].priority; });
    return order[sorted];
  }
  /// Why a transition is never taken; empty: it may be taken.
  std::string why_dead(size_t s, size_t t) const {
    const ChartState& state = chart_.states[s];
    const Guard& guard = *state.transitions[t].guard;
    if (truth_of(guard) == Truth::never) return "its guard is always false";
    for (const int outer : state.chain) {
      const auto& tested = chart_.states[size_t(outer)].transitions;
      const bool is_own = outer == int(s);
      for (size_t before = 0; before < (is_own ? t : tested.size()); ++before) {
        const Guard& earlier = *tested[before].guard;
        const bool is_same = earlier.text() == guard.text() && (is_own || !guard.waits());
        if (truth_of(earlier) == Truth::always || is_same)
          return fmt::format(
              "the transition{} to \"{}\" is tested before it and {}",
              is_own ? "" : fmt::format(" of \"{}\"", states_[size_t(outer)]),
              states_[size_t(tested[before].to)],
              is_same && truth_of(earlier) != Truth::always ? "has the same guard" : "is always taken");
      }
    }
    return "";
  }
  void warn_of_transitions() {
    for (size_t s = 0; s < states_.size(); ++s)
      for (size_t t = 0; t < chart_.states[s].transitions.size(); ++t) {
        const std::string why = why_dead(s, t);
        if (why.empty()) continue;
        const size_t at = written(s, t);
        dead_.insert({s, t});
        warning(value_of(s, at, "when"),
                fmt::format("the transition from \"{}\" to \"{}\" is never taken: {}", states_[s],
                            machine_.states[s].transitions[at].to, why));
      }
  }
  void warn_of_states() {
    std::set<int> reached;
    std::vector<int> todo = chart_.enters;
    while (!todo.empty()) {
      const int s = todo.back();
      todo.pop_back();
      if (!reached.insert(s).second) continue;
      const auto& transitions = chart_.states[size_t(s)].transitions;
      for (size_t t = 0; t < transitions.size(); ++t)
        if (!dead_.contains({size_t(s), t}))
          todo.insert(todo.end(), transitions[t].enters.begin(), transitions[t].enters.end());
    }
    for (size_t s = 0; s < states_.size(); ++s) {
      const int parent = chart_.states[s].parent;
      if (reached.contains(int(s)) || (parent >= 0 && !reached.contains(parent))) continue;
      Problem& problem =
          warning(value_of(s, "name"), fmt::format("the state \"{}\" cannot be reached", states_[s]));
      problem.hint = "no transition that may be taken leads to it";
    }
  }
  void warn_of_ports() {
    for (size_t i = 0; i < machine_.inputs.size(); ++i) {
      const bool is_read = std::ranges::any_of(chart_.states, [&](const ChartState& state) {
        return std::ranges::any_of(state.transitions, [&](const ChartTransition& transition) {
          return transition.guard->reads(machine_.inputs[i]);
        });
      });
      if (!is_read)
        warning(checker_.settings().find("inputs")->value.items[i],
                fmt::format("no guard reads the input \"{}\"", machine_.inputs[i]));
    }
    for (size_t o = 0; o < outputs_.size(); ++o) {
      const bool is_set = std::ranges::any_of(machine_.states, [&](const MachineState& state) {
        return std::ranges::any_of(state.set.entries,
                                   [&](const auto& entry) { return entry.first == outputs_[o]; });
      });
      if (!is_set)
        warning(checker_.settings().find("outputs")->value.items[o],
                fmt::format("no state sets the output \"{}\": it stays 0", outputs_[o]));
    }
  }

  MachineSettings& machine_;
  const Checker& checker_;
  std::vector<std::string> states_, outputs_;
  StateChart chart_;
  std::set<std::pair<size_t, size_t>> dead_;  // state and transition, in the order of the chart
};

}  // namespace

void check_machine(MachineSettings& settings, const Checker& checker) {
  MachineCheck(settings, checker).run();
}

}  // namespace loopwright::blocks
