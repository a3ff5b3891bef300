#include "tools/compare/machine.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include "tools/compare/joined_bodies.h"
#include "tools/experiment/even_grid.h"
#include "models/real/whole.h"

namespace loopwright {
namespace {

const std::string* port_of(const Experiment& experiment, std::string_view role) {
  for (const auto& [name, port] : experiment.roles.ports)
    if (name == role) return &port;
  return nullptr;
}

/// The recorded signal of a port: of the port itself, or of one that is the same number in the plan.
const RecordedSignal* recorded(const Experiment& experiment, const Plan& plan, const std::string& port,
                               bool also_driven) {
  const std::vector<Number> wanted = plan.find(port);
  const auto is_it = [&](const RecordedSignal& signal) {
    return signal.port == port || (!wanted.empty() && plan.find(signal.port) == wanted);
  };
  if (also_driven)
    for (const RecordedSignal& signal : experiment.drives)
      if (is_it(signal)) return &signal;
  for (const RecordedSignal& signal : experiment.compared)
    if (is_it(signal)) return &signal;
  return nullptr;
}

/// The rows of the motion; empty: `why` says what is lacking.
std::optional<SlowerRows> measure_motion(const Experiment& experiment, const Plan& plan, MeasuredMotion& m,
                                         std::string& why) {
  const std::string* position = port_of(experiment, "position");
  const std::string* velocity = port_of(experiment, "velocity");
  const RecordedSignal* x = position ? recorded(experiment, plan, *position, false) : nullptr;
  const RecordedSignal* v = velocity ? recorded(experiment, plan, *velocity, false) : nullptr;
  if (!x && !v) {
    why = "neither the position nor the velocity of the roles is compared with a measurement";
    return {};
  }
  const SlowerRows rows = (x ? x : v)->rows;
  if (experiment.data.rows() < 50 * rows.every) {
    why = "the record is too short";
    return {};
  }
  why = too_many_missing(experiment);
  if (!why.empty()) return {};
  const EvenGrid grid(experiment);
  if (!rows.are_all() && !(grid.missing().empty() && grid.duration().empty())) {
    why = fmt::format("\"{}\" has a reading in one of {} rows, and these are not evenly in time",
                      (x ? x : v)->port, rows.every);
    return {};
  }
  m.start = grid.start() + double(rows.first) * grid.sample_time();
  m.sample_time = double(rows.every) * grid.sample_time(), m.missing = grid.missing();
  const auto readings = [&](const RecordedSignal& of) {
    return picked(rows,
                  at_even_instants(grid.measured(experiment.data.find(of.port)->values), grid.duration()));
  };
  if (x) {
    m.raw_position = readings(*x);
    m.position_unit = experiment.data.find(x->port)->unit;
  } else {
    m.velocity = readings(*v);
    const std::string& unit = experiment.data.find(v->port)->unit;
    m.position_unit = unit == "Hz"           ? "1"
                      : unit.ends_with("/s") ? unit.substr(0, unit.size() - 2)
                                             : unit + "*s";
  }
  for (size_t k = 0; k < (x ? m.raw_position : m.velocity).size(); ++k)
    m.time.push_back(m.start + double(k) * m.sample_time);
  smooth_motion(m);
  return rows;
}

/// The solver for the record: fixed steps that divide a sample.
void use_fixed_steps(LoadOptions& options, const Plan& plan, const MeasuredMotion& motion) {
  const double sample_time = motion.sample_time;
  const double wanted = plan.step_ticks > 0 ? plan.clock.time(plan.step_ticks) : sample_time / 10;
  const double steps = std::clamp(std::round(sample_time / wanted), 4.0, 100.0);
  options.set.emplace_back("solver.method", "rk4");
  options.set.emplace_back("solver.step", fmt::format("{} s", sample_time / steps));
  options.set.emplace_back("solver.start", fmt::format("{} s", motion.start));
}

/// The diagram with the recorded input in place of the signal that feeds the machine's input.
std::shared_ptr<const Plan> driven_plan(const std::string& diagram, const Experiment& experiment,
                                        const LoadOptions& options, const RecordedSignal& input,
                                        const std::string& port, bool is_driven, const MeasuredMotion& motion,
                                        std::string& why) {
  Experiment open = experiment;
  if (!is_driven) {
    RecordedSignal drive = input;
    drive.port = port;
    open.drives.push_back(std::move(drive));
  }
  Problems problems;
  auto load = [&](const LoadOptions& with) -> std::shared_ptr<const Plan> {
    const auto loaded = load_diagram(diagram, follow(open, with), problems);
    return loaded ? compile(*loaded, problems) : nullptr;
  };
  const auto first = load(options);
  if (first) {
    LoadOptions fixed = options;
    use_fixed_steps(fixed, *first, motion);
    if (const auto plan = load(fixed)) return plan;
  }
  why = fmt::format("the diagram does not run with the recorded input at \"{}\": {}", port,
                    problems.list().empty() ? "" : problems.list().front().message);
  return nullptr;
}

/// The unit in the driven plan, else in the original diagram: there the source of the input may determine it.
std::optional<Unit> unit_of_port(const std::string& port, const Plan& driven, const std::string& diagram,
                                 const LoadOptions& options) {
  const auto unit_in = [&](const Plan& plan) {
    const std::vector<Number> numbers = plan.find(port);
    return numbers.size() == 1 ? plan.unit_of(numbers[0]) : std::nullopt;
  };
  if (const auto unit = unit_in(driven)) return unit;
  Problems problems;
  const auto loaded = load_diagram(diagram, options, problems);
  const auto plan = loaded ? compile(*loaded, problems) : nullptr;
  return plan ? unit_in(*plan) : std::nullopt;
}

/// The input stays zero.
std::shared_ptr<const Plan> without_input(const Plan& plan, const std::string& port) {
  auto changed = std::make_shared<Plan>(plan);
  for (Number number : plan.find(port)) silence(*changed, number);
  return changed;
}

/// True where two ports cannot be the same quantity.
bool differ_in_unit(const Plan& plan, Number a, Number b) {
  const auto of_a = plan.unit_of(a), of_b = plan.unit_of(b);
  return of_a && of_b && !of_a->same_dimension(*of_b);
}

/// Steps a run over one sample and calls `at_begin` and `at_end`.
class Stepper {
 public:
  Stepper(const Machine& machine, const Plan& plan)
      : machine_(machine),
        run_(plan),
        period_(int64_t(whole_count(std::round(machine.motion.sample_time / plan.clock.time(1))))) {
    switch_off_noise(run_, plan);
    run_.reset({plan.seed, 0});
  }
  explicit Stepper(const Machine& machine) : Stepper(machine, *machine.plan) {}

  void set(double position, double velocity) {
    const int first = machine_.plan->signals;
    run_.states()[size_t(machine_.position - first)] = position;
    run_.states()[size_t(machine_.velocity - first)] = velocity;
  }
  /// The same with all that hangs on the axis.
  void restart(double position, double velocity) {
    carry_along(*machine_.plan, machine_.position, machine_.velocity, position, velocity,
                run_.states().data());
    set(position, velocity);
  }
  double position() const { return run_.number(machine_.position); }
  double sensed() const { return run_.number(machine_.sensor); }
  double velocity() const { return run_.number(machine_.velocity); }
  double net_force() const { return machine_.net_force < 0 ? 0 : run_.number(machine_.net_force); }
  /// Returns false when a block stopped the run.
  bool step() {
    const int64_t end = run_.now().tick + period_;
    while (run_.now().tick < end && !run_.failed()) run_.step_fixed(end, true, [] {});
    return !run_.failed();
  }
  /// Net force at this instant, with the states as set.
  double evaluate() {
    run_.evaluate(run_.due(), true);
    return net_force();
  }

 private:
  const Machine& machine_;
  Run<double> run_;
  int64_t period_;
};

/// Whether nothing is known of the motion before this row.
bool begins_anew(const MeasuredMotion& m, size_t row) {
  return row == 0 || (m.is_missing(row - 1) && !m.is_missing(row));
}

/// Subtracts the position error of the model's sensor from the measured position. The machine is then where
/// the sensor would give the measured value. Two iterations suffice for errors far smaller than their period.
void take_out_sensor_error(Machine& machine) {
  if (is_sampled_between(*machine.plan, machine.position, machine.sensor)) return;
  MeasuredMotion& m = machine.motion;
  Stepper stepper(machine);
  for (double& place : m.raw_position) {
    const double measured = place;
    for (int round = 0; round < 2; ++round) {
      stepper.set(place, 0);
      stepper.evaluate();
      place -= stepper.sensed() - measured;
    }
  }
  smooth_motion(m);
}

/// Nobody measures the position: it begins where the model does.
void begin_where_the_model_does(Machine& machine) {
  shift_position(machine.motion, Stepper(machine).position());
}

}  // namespace

void switch_off_noise(Run<double>& run, const Plan& plan) {
  for (const Plan::Block& block : plan.blocks)
    if (double* level =
            block.type->info.type == "Noise" ? run.parameter(block.path + ".standard_deviation") : nullptr)
      *level = 0;
}

Number state_behind(const Plan& plan, Number number) {
  std::vector<Number> todo{number};
  for (size_t i = 0; i < todo.size(); ++i) {  // nearest first
    if (is_state(plan, todo[i]) && !differ_in_unit(plan, todo[i], number)) return todo[i];
    const int source = plan.source_of(todo[i]).first;
    if (source < 0) continue;
    for (const auto& port : plan.blocks[size_t(source)].inputs)
      for (Number input : port)
        if (input >= 0 && std::ranges::find(todo, input) == todo.end()) todo.push_back(input);
  }
  return -1;
}

bool is_sampled_between(const Plan& plan, Number state, Number sensor) {
  for (Number at = sensor; at != state;) {
    const int source = plan.source_of(at).first;
    if (source < 0) return true;
    const Plan::Block& block = plan.blocks[size_t(source)];
    if (block.period > 0) return true;
    Number next = -1;
    for (const auto& port : block.inputs)
      for (Number input : port)
        if (next < 0 && state_behind(plan, input) == state) next = input;
    if (next < 0) return true;
    at = next;
  }
  return false;
}

std::optional<Machine> find_machine(const std::string& diagram, const Experiment& experiment,
                                    const LoadOptions& options, std::string& why) {
  const std::string* input_port = port_of(experiment, "input");
  const std::string *position = port_of(experiment, "position"), *velocity = port_of(experiment, "velocity");
  if (!input_port || !position || !velocity) {
    why = "the experiment names no roles \"input\", \"position\" and \"velocity\"";
    return {};
  }
  Problems problems;
  const auto loaded = load_diagram(diagram, follow(experiment, options), problems);
  const auto plan = loaded ? compile(*loaded, problems) : nullptr;
  if (!plan) {
    why = "the diagram has errors";
    return {};
  }
  Machine machine;
  const auto rows = measure_motion(experiment, *plan, machine.motion, why);
  if (!rows) return {};
  const bool is_driven =
      std::ranges::any_of(experiment.drives, [&](const auto& d) { return d.port == *input_port; });
  const RecordedSignal* input = recorded(experiment, *plan, *input_port, true);
  if (!input) {
    why = fmt::format(
        "the input \"{}\" was not recorded: neither \"drive\" nor \"compare\" has a column for it",
        *input_port);
    return {};
  }
  if (!input->rows.are_all()) {
    why = fmt::format("the input \"{}\" was recorded in one of {} rows only", *input_port, input->rows.every);
    return {};
  }
  const EvenGrid grid(experiment);
  const std::vector<double>& command = experiment.data.find(input->port)->values;
  machine.motion.input = means_from(
      *rows, mean_over_even_samples(grid.driving(command, input->between_rows).mean, grid.duration()));
  machine.motion.input_unit = experiment.data.find(input->port)->unit;
  machine.plan =
      driven_plan(diagram, experiment, options, *input, *input_port, is_driven, machine.motion, why);
  if (!machine.plan) return {};
  machine.undriven = without_input(*machine.plan, *input_port);
  const auto x = machine.plan->find(*position), v = machine.plan->find(*velocity);
  machine.position = x.size() == 1 ? state_behind(*machine.plan, x[0]) : -1;
  machine.velocity = v.size() == 1 ? state_behind(*machine.plan, v[0]) : -1;
  if (machine.position < 0 || machine.velocity < 0) {
    why = "the roles \"position\" and \"velocity\" lead to no states of the model, such as those of a Mass";
    return {};
  }
  if (machine.position == machine.velocity) {
    why = "the roles \"position\" and \"velocity\" lead to one state of the model";
    return {};
  }
  machine.sensor = x[0];
  if (const std::string* force = port_of(experiment, "force"))
    if (const auto number = machine.plan->find(*force); number.size() == 1) {
      machine.net_force = number[0];
      machine.force_unit = unit_of_port(*force, *machine.plan, diagram, with_own_values(experiment, options));
    }
  if (!recorded(experiment, *plan, *position, false))
    begin_where_the_model_does(machine);
  else if (machine.sensor != machine.position)
    take_out_sensor_error(machine);
  return machine;
}

void silence(Plan& plan, Number number) {
  const int block = plan.source_of(number).first;
  std::erase_if(plan.order, [&](const Plan::Entry& entry) {
    return entry.kind != Plan::Entry::Kind::algebraic_loop && entry.block == block;
  });
}

std::vector<double> driving_force(const std::vector<double>& with_input,
                                  const std::vector<double>& without_input) {
  std::vector<double> force(with_input.size());
  for (size_t k = 0; k < force.size(); ++k) force[k] = with_input[k] - without_input[k];
  return force;
}

std::string unit_of_force(const std::optional<Unit>& known, const MeasuredMotion& motion) {
  if (known) return to_string(*known);
  constexpr double rounding = 1e-9;  // of the input, because forces were added to it and subtracted again
  double level = 0, difference = 0;
  for (size_t k = 0; k < motion.input.size(); ++k) {
    level = std::max(level, std::abs(motion.input[k]));
    difference = std::max(difference, std::abs(motion.force[k] - motion.input[k]));
  }
  return difference <= rounding * level ? motion.input_unit : "1";
}

std::vector<double> model_acceleration(Machine& machine) {
  MeasuredMotion& m = machine.motion;
  Stepper stepper(machine), undriven(machine, *machine.undriven);
  std::vector<double> acceleration, driven_force, other_force;
  double force_by_acceleration = 0, squared_acceleration = 0;
  for (size_t k = 0; k < m.rows(); ++k) {
    for (Stepper* run : {&stepper, &undriven}) {
      if (begins_anew(m, k))
        run->restart(m.position[k], m.velocity[k]);
      else
        run->set(m.position[k], m.velocity[k]);
    }
    const double before = stepper.evaluate();
    driven_force.push_back(before), other_force.push_back(undriven.evaluate());
    if (!stepper.step() || !undriven.step()) break;
    acceleration.push_back((stepper.velocity() - m.velocity[k]) / m.sample_time);
    // The force was read at the last step within the sample, so on average in its middle.
    const double force = 0.5 * (before + stepper.net_force());
    force_by_acceleration += force * acceleration.back();
    squared_acceleration += acceleration.back() * acceleration.back();
  }
  acceleration.resize(m.rows(), acceleration.empty() ? 0 : acceleration.back());
  m.force = driving_force(driven_force, other_force);
  m.force.resize(m.rows());
  m.force_unit = unit_of_force(machine.force_unit, m);
  if (machine.net_force >= 0 && squared_acceleration > 0)
    machine.mass = force_by_acceleration / squared_acceleration;
  return acceleration;
}

std::vector<double> simulate_position(const Machine& machine, size_t horizon) {
  const MeasuredMotion& m = machine.motion;
  Stepper stepper(machine);
  std::vector<double> position;
  for (size_t k = 0; k < m.rows(); ++k) {
    if (begins_anew(m, k) || (horizon > 0 && k % horizon == 0)) stepper.restart(m.position[k], m.velocity[k]);
    position.push_back(stepper.position());
    if (!stepper.step()) break;
  }
  return position;
}

}  // namespace loopwright
