/// What a state machine reads from its settings.
#pragma once
#include "blocks/logic/state_chart.h"

namespace loopwright::blocks {

struct MachineOutput {
  std::string name, unit;
  static constexpr auto describe() {
    return fields(
        parameter(&MachineOutput::name, "name", "", "Name of the port"),
        parameter(&MachineOutput::unit, "unit", "", "Its unit; a plain number when empty").optional());
  }
};

struct MachineTransition {
  std::string to, when;
  int priority = 0;
  static constexpr auto describe() {
    return fields(parameter(&MachineTransition::to, "to", "", "State that it leads to"),
                  parameter(&MachineTransition::when, "when", "",
                            "Guard, as in \"switch && after(0.5 s)\", true above 0.5; always true when empty")
                      .optional(),
                  parameter(&MachineTransition::priority, "priority", "",
                            "1 is tested first; without priorities the order of the list counts")
                      .at_least(0)
                      .optional());
  }
};

struct MachineState {
  std::string name, inside, initial;
  ByName<double> set;
  std::vector<MachineTransition> transitions;
  static constexpr auto describe() {
    return fields(
        parameter(&MachineState::name, "name", "", "Name of the state"),
        parameter(&MachineState::inside, "inside", "", "State that contains it").optional(),
        parameter(&MachineState::initial, "initial", "",
                  "State inside it that is entered with it; the first one when empty")
            .optional(),
        parameter(&MachineState::set, "set", unit_of_output, "Values that outputs get when it is entered")
            .optional(),
        parameter(&MachineState::transitions, "transitions", "", "Ways out of it").optional());
  }
};

struct MachineSettings {
  std::vector<std::string> inputs;
  std::vector<MachineOutput> declared_outputs;
  std::vector<MachineState> states;
  std::string initial;
  std::vector<NamedNumber> constants;

  std::vector<std::vector<Place>> places;  ///< of the guards, by state; set by the check

  GuardNames guard_names() const { return {inputs, constants}; }
};

/// Reports all mistakes; warns of states that cannot be reached, of transitions that cannot be taken, and of
/// inputs and outputs without use.
void check_machine(MachineSettings& settings, const Checker& checker);

/// Whether the guards compare equal units; `of_inputs` in the order of the names.
FormulaUnit unit_of_guards(const MachineSettings& settings, std::span<const Unit> of_inputs);

/// The settings must have no errors.
StateChart chart_of(const MachineSettings& settings);

}  // namespace loopwright::blocks
