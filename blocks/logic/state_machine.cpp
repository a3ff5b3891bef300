/// One state is active, with the states that contain it. At the first sample the initial state is entered. At
/// every further sample the transitions of the active states are tested: those of the outermost state first,
/// then those of the states inside it, each in the order of their priority. The first one whose guard is true
/// is taken. There is at most one in a sample.
///
/// A transition leaves the active states up to its source, which is left too, and enters its target. With a
/// state the states that contain it are entered before it, unless they stay active, and its initial state
/// after it. Entering a state sets outputs, the outer before the inner ones. An output that is not set keeps
/// its value; before it is set it is 0. Outputs and `state` change in the sample of the transition. Numbers
/// for an output whose unit is not one of SI, such as mm, need a unit of their own.
///
/// after(0.5 s) is true from the first sample at which the state with the transition has been active for that
/// time. In a subdiagram that does not always run, only the samples at which it runs count.
#include "blocks/logic/state_machine.h"

namespace loopwright::blocks {

struct StateMachine : MachineSettings {
  struct In {
    NamedInputs<double> inputs;
  };
  struct Out {
    double state;
    NamedOutputs<double> outputs;
  };
  struct Memory {
    double active;           // -1: before the first sample
    Vector<double> samples;  // of each active state: since it was entered
    Vector<double> values;   // of the outputs
  };
  StateChart chart{};      // belongs to one run, as its guards do
  double sample_time = 0;  // s

  static constexpr auto describe() {
    return block(
        "States with outputs, and transitions between them.",
        parameter(&StateMachine::inputs, "inputs", "", "Names of its inputs").optional(),
        parameter(&StateMachine::declared_outputs, "outputs", "", "Its outputs beside `state`").optional(),
        parameter(&StateMachine::states, "states", "", "The states, numbered from 0"),
        parameter(&StateMachine::initial, "initial", "", "State at the start; the first one when empty")
            .optional(),
        parameter(&StateMachine::constants, "constants", "",
                  "Further numbers; parameters of the diagram in the guards are added by themselves")
            .optional(),
        input(&In::inputs, "inputs", any_unit, "A signal for each name in `inputs`"),
        output(&Out::state, "state", "", "Number of the innermost active state"),
        output(&Out::outputs, "outputs", "", "A signal for each name in `outputs`"),
        buffer(&Memory::samples, &StateMachine::state_count),
        buffer(&Memory::values, &StateMachine::output_count));
  }
  int state_count() const { return int(states.size()); }
  int output_count() const { return int(declared_outputs.size()); }
  std::vector<InstancePort> input_ports() const {
    std::vector<InstancePort> ports;
    for (const std::string& name : inputs)
      ports.push_back({name, std::string(any_unit), "Signal that guards may name"});
    return ports;
  }
  std::vector<InstancePort> output_ports() const {
    std::vector<InstancePort> ports;
    for (const MachineOutput& output : declared_outputs)
      ports.push_back({output.name, output.unit, "Set by the states"});
    return ports;
  }
  FormulaUnit formula_unit(std::span<const Unit> of_wires) const { return unit_of_guards(*this, of_wires); }
  void check(const Checker& checker) { check_machine(*this, checker); }

  void prepare(double time_between_samples) {
    chart = chart_of(*this);
    sample_time = time_between_samples;
  }
  void start(Memory& memory) const { memory.active = -1; }
  Fault outputs(const In& in, const Memory& memory, Out& out) const {
    const Next next = find_next(in, memory);
    for (int i = 0; i < output_count(); ++i) out.outputs[i] = memory.values[size_t(i)];
    for (const int state : next.enters)
      for (const auto& [output, value] : chart.states[size_t(state)].set) out.outputs[output] = value;
    out.state = next.enters.empty() ? memory.active : next.enters.back();
    return fault_if(next.failed, "an input or a guard is not a number");
  }
  Fault update(const In& in, Memory& memory) const {
    const Next next = find_next(in, memory);
    if (memory.active >= 0)
      for (const int state : chart.states[size_t(memory.active)].chain) memory.samples[size_t(state)] += 1;
    for (const int state : next.enters) {
      memory.samples[size_t(state)] = 0;
      for (const auto& [output, value] : chart.states[size_t(state)].set)
        memory.values[size_t(output)] = value;
      memory.active = state;
    }
    return fault_if(next.failed, "an input or a guard is not a number");
  }

 private:
  struct Next {
    std::span<const int> enters{};  // nothing: no transition is taken
    bool failed = false;
  };
  Next find_next(const In& in, const Memory& memory) const {
    for (size_t i = 0; i < inputs.size(); ++i)
      if (std::isnan(in.inputs[int(i)])) return {{}, true};
    if (memory.active < 0) return {chart.enters};
    for (const int state : chart.states[size_t(memory.active)].chain)
      for (const ChartTransition& transition : chart.states[size_t(state)].transitions) {
        const Guard& guard = *transition.guard;
        for (size_t i = 0; i < guard.inputs(); ++i) guard.set_input(i, in.inputs[int(i)]);
        const double value = guard.value(memory.samples[size_t(state)] + 1, sample_time);
        if (std::isnan(value)) return {{}, true};
        if (value > 0.5) return {transition.enters};
      }
    return {};
  }
};
LOOPWRIGHT_BLOCK(StateMachine)

}  // namespace loopwright::blocks
