#include "tools/experiment/experiment_ports.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <set>
#include "engine/json/reader.h"

namespace loopwright {
namespace {

/// Generated blocks that play a recorded column: they are not in the user's diagram and not addressed by
/// name.
bool is_driver(std::string_view port) { return port.starts_with("recorded_"); }

/// The numbers of a port. One wire of a list that is driven, "force.terms[0]", has those of its driver.
std::vector<Number> numbers_of(const Plan& plan, const std::string& port) {
  std::vector<Number> numbers = plan.find(port);
  if (!numbers.empty() || !port.ends_with(']')) return numbers;
  std::string driver = "recorded_" + port;
  std::ranges::replace_if(
      driver, [](char c) { return c == '.' || c == '[' || c == ']'; }, '_');
  numbers = plan.find(driver + ".value");                       // of a recorded column
  return numbers.empty() ? plan.find(driver + ".y") : numbers;  // of a placeholder
}

/// The port's number. Reports a problem if the diagram has no such port, or one of another dimension.
std::optional<Number> find_port(const Plan& plan, const std::string& port,
                                const std::optional<std::string>& unit, const Place& place,
                                const std::string& pointer, Problems& problems) {
  const std::vector<Number> numbers = numbers_of(plan, port);
  if (numbers.size() != 1) {
    auto& p = problems.error(place, pointer, "",
                             numbers.empty() ? fmt::format("the diagram has no port \"{}\"", port)
                                             : fmt::format("\"{}\" has {} elements: name one, \"{}[0]\"",
                                                           port, numbers.size(), port));
    std::vector<std::string> names;
    for (const Plan::Port& known : plan.ports)
      if (!is_driver(known.name)) names.emplace_back(known.name);
    if (numbers.empty()) KnownNames(names).explain(p, port);
    return {};
  }
  const auto of_port = plan.unit_of(numbers[0]), of_data = unit ? parse_unit(*unit) : std::nullopt;
  if (!of_port || !of_data) return numbers[0];
  const Conversion::Kind kind = conversion(*of_data, *of_port).kind;
  const bool is_count = of_port->radians() > 0 && of_data->radians() == 0 && is_counted(*unit);
  if (!is_count && (kind == Conversion::Kind::none || kind == Conversion::Kind::turns)) return numbers[0];
  auto& p =
      problems.error(place, pointer, "", fmt::format("\"{}\" is in another unit than its column", port));
  p.expected = to_string(*of_port), p.found = *unit;
  if (is_count)
    p.hint =
        "a count is no radian: state what one count is in \"columns\" of the experiment, {\"column\": …, "
        "\"scale\": 7.67e-4, \"unit\": \"rad\"} for 8192 counts a turn";
  if (kind == Conversion::Kind::ambiguous)
    p.hint =
        "are these cycles (Hz), revolutions (rpm), radians (rad/s) or plain numbers (1/s)? give the column "
        "the unit that is meant";
  return numbers[0];
}

std::string hint_at_unit(const Experiment& experiment, std::string_view unit) {
  return fmt::format("is the time \"{0}\" in {1}? then its heading is \"{0} [{1}]\"", experiment.time_column,
                     unit);
}

/// The same of a diagram without samples, whose rows are far more steps of its solver apart than anyone
/// needs. Whether no motion of an axis can be followed from one to the next, however stiff its diagram is.
bool check_against_steps(const Plan& plan, const Experiment& experiment, Problems& problems) {
  constexpr double most_steps = 2000;  // in a row; an accurate simulation has some tens
  constexpr double longest_row = 0.5;  // s, of logs of axes
  const double step = plan.clock.time(plan.step_ticks), row = experiment.time.sample_time;
  if (plan.step_ticks <= 0 || !plan.steps_between_samples || row <= most_steps * step) return false;
  problems
      .warning(experiment.place, std::string(time_of_rows), "",
               fmt::format("the rows are {:.6g} s apart, which is {:.0f} steps of the diagram's solver", row,
                           row / step))
      .hint = hint_at_unit(experiment, "ms");
  return row > longest_row;
}

/// A constant in place of a recorded column, whether that exists or not.
Drive placeholder(const RecordedSignal& signal) {
  Drive drive;
  drive.port = signal.port, drive.type = "ExternalSignal", drive.output = "y";
  drive.settings.kind = Value::Kind::object;
  drive.settings.place = signal.place;
  return drive;
}

void add_errors(const std::vector<Problem>& list, size_t from, Problems& to) {
  std::set<std::string> told;
  for (const Problem& problem : to.list()) told.insert(to_string(problem));
  for (size_t i = from; i < list.size(); ++i)
    if (list[i].severity == Problem::Severity::error && told.insert(to_string(list[i])).second)
      to.add(list[i]);
}

/// The drives that lead to ports of the diagram; each of the others is a problem.
LoadOptions with_drives(const std::string& diagram, const Experiment& experiment, LoadOptions options,
                        Problems& problems) {
  const auto [first, last] = std::pair(options.set.begin(), options.set.end());
  if (std::none_of(first, last, [](const auto& option) { return option.first == "solver.stop"; }))
    options.set.insert(options.set.begin(), {"solver.stop", "1 s"});  // the value from the experiment
  Problems without;
  load_diagram(diagram, options, without);
  const size_t own = without.list().size();
  std::vector<Drive> good;
  for (const RecordedSignal& signal : experiment.drives) {
    Problems with;
    LoadOptions one = options;
    one.drives.push_back(placeholder(signal));
    load_diagram(diagram, one, with);
    if (with.list().size() == own) good.push_back(one.drives.back());
    add_errors(with.list(), own, problems);
  }
  options.drives = std::move(good);
  return options;
}

}  // namespace

bool check_unit_of_time(const Plan& plan, const Experiment& experiment, Problems& problems) {
  constexpr double near = 20, alike = 0.01;  // times; of the factor
  struct Scale {
    double factor;
    std::string_view unit;
  };
  constexpr Scale scales[] = {{1e3, "ms"}, {1e6, "us"}, {1e9, "ns"}, {1e-3, "s"}, {1e-6, "s"}};
  const double step = experiment.time.sample_time;
  if (step <= 0) return false;
  const Scale* found = nullptr;
  double sample_time = 0;
  bool is_sampled = false;
  for (const Plan::Block& block : plan.blocks) {
    if (block.sample_time <= 0) continue;
    is_sampled = true;
    const double ratio = step / block.sample_time;
    if (ratio < near && ratio > 1 / near) return false;
    for (const Scale& scale : scales)
      if (std::abs(ratio / scale.factor - 1) < alike) found = &scale, sample_time = block.sample_time;
  }
  if (!is_sampled) return check_against_steps(plan, experiment, problems);
  if (!found) return false;
  auto& p = problems.warning(
      experiment.place, std::string(time_of_rows), "",
      fmt::format("the rows are {:.6g} s apart, and the diagram has samples of {:.6g} s", step, sample_time));
  p.hint = found->factor > 1 ? hint_at_unit(experiment, found->unit)
                             : fmt::format("is the unit of the time \"{}\" right?", experiment.time_column);
  return found->factor > 1;
}

Plan logging(const Plan& plan, const Experiment& experiment, Problems& problems) {
  check_unit_of_time(plan, experiment, problems);
  Plan changed = plan;
  changed.log.clear();
  const auto log = [&](const std::string& name, const std::optional<std::string>& unit, const Place& place,
                       const std::string& pointer) {
    const auto number = find_port(plan, name, unit, place, pointer, problems);
    if (!number || std::ranges::any_of(changed.log, [&](const Plan::Logged& l) { return l.name == name; }))
      return;
    Plan::Logged logged;
    logged.name = name, logged.number = *number;
    if (const auto known = plan.unit_of(*number)) logged.unit = *known, logged.unit_is_known = true;
    changed.log.push_back(std::move(logged));
  };
  for (const RecordedSignal& signal : experiment.compared) {
    const bool is_read =
        experiment.data.find(signal.port) != nullptr;  // else its unit may be that of the heading
    log(signal.port, is_read ? std::optional(signal.unit) : std::nullopt, signal.place, signal.pointer);
  }
  for (const RecordedSignal& signal : experiment.drives)
    find_port(plan, signal.port, signal.unit, signal.place, signal.pointer, problems);
  for (size_t i = 0; i < experiment.roles.ports.size(); ++i)
    log(experiment.roles.ports[i].second, std::nullopt, experiment.roles.places[i],
        "/roles/" + experiment.roles.ports[i].first);
  return changed;
}

Experiment in_units_of_ports(const Plan& plan, Experiment experiment) {
  for (RecordedSignal& signal : experiment.compared) {
    const std::vector<Number> numbers = plan.find(signal.port);
    const auto of_port = numbers.size() == 1 ? plan.unit_of(numbers[0]) : std::nullopt;
    const auto of_data = parse_unit(signal.unit);
    const auto column = std::ranges::find(experiment.data.columns, signal.port, &Column::name);
    if (!of_port || !of_data || column == experiment.data.columns.end()) continue;
    const Conversion to_port = conversion(*of_data, *of_port);
    if (to_port.kind != Conversion::Kind::turns) continue;
    for (double& value : column->values) value = to_port(value);
    column->unit = signal.unit = to_string(of_port->in_si());
    signal.resolution = to_port(signal.resolution);
  }
  return experiment;
}

void explain_failure(const std::string& path, const std::vector<std::string>& experiments,
                     const LoadOptions& options, Problems found) {
  for (const std::string& experiment_path : experiments) {
    Problems problems;
    const auto experiment = read_experiment(experiment_path, problems);
    const Experiment& read = experiment ? *experiment : Experiment{};
    const LoadOptions driven = with_drives(path, read, with_own_values(read, options), problems);
    Problems of_diagram;
    const auto diagram = load_diagram(path, driven, of_diagram);
    const auto plan = diagram ? compile(*diagram, of_diagram) : nullptr;
    add_errors(of_diagram.list(), 0, problems);
    if (plan && experiment) logging(*plan, *experiment, problems);
    add_errors(problems.list(), 0, found);
  }
  throw InputError(std::move(found));
}

}  // namespace loopwright
