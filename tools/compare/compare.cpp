#include "tools/compare/compare.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include "engine/diagram/in_memory.h"
#include "models/real/whole.h"
#include "tools/experiment/balances.h"
#include "tools/experiment/experiment_ports.h"

namespace loopwright {
namespace {

/// What two times may differ by and still be the same instant: a small part of a row, and what their numbers
/// can tell. A time of day is far from zero, so a share of the time itself would be many rows.
double same_instant(double time, double row_s) {
  constexpr double share_of_row = 1e-6, roundings = 8;
  return share_of_row * row_s + roundings * std::numeric_limits<double>::epsilon() * std::abs(time);
}

/// Recorded times that a run reached. Stamps are rounded, and the last row is not lost for that.
size_t reached_rows(const Recording& simulated, const std::vector<double>& times) {
  const std::vector<double>& t = simulated.columns[0].values;
  if (t.empty()) return 0;
  const double last_row_s = t.size() > 1 ? t.back() - t[t.size() - 2] : 0;
  const auto beyond = std::ranges::find_if(times, [&](double time) {
    return t.back() < time - 0.01 * last_row_s - same_instant(time, last_row_s);
  });
  return size_t(beyond - times.begin());
}

/// Values of a simulated column at the recorded times: the row's value where the times coincide, otherwise
/// linear interpolation.
std::vector<double> at_times(const Recording& simulated, const Column& column,
                             const std::vector<double>& times) {
  const std::vector<double>& t = simulated.columns[0].values;
  std::vector<double> values;
  const size_t reached = reached_rows(simulated, times);
  values.reserve(reached);
  size_t i = 0;
  for (double time : std::span(times).first(reached)) {
    while (i + 1 < t.size() && t[i + 1] <= time + same_instant(time, t[i + 1] - t[i])) ++i;
    const bool coincides = i + 1 == t.size() || std::abs(t[i] - time) <= same_instant(time, t[i + 1] - t[i]);
    const double s = coincides ? 0 : (time - t[i]) / (t[i + 1] - t[i]);
    values.push_back(coincides ? column.values[i] : (1 - s) * column.values[i] + s * column.values[i + 1]);
  }
  return values;
}

double rms(std::span<const double> values) {
  double sum = 0;
  for (double v : values) sum += v * v;
  return values.empty() ? 0 : std::sqrt(sum / double(values.size()));
}

void measure(ComparedSignal& signal, double hold_out_fraction) {
  const size_t n = signal.simulated.size(), rows = signal.measured.size();
  signal.measured.resize(n);
  double mean = 0;
  for (double y : signal.measured) mean += y / double(n);
  std::vector<double> around_mean;
  for (size_t i = 0; i < n; ++i) {
    signal.error.push_back(signal.simulated[i] - signal.measured[i]);
    signal.max_abs = std::max(signal.max_abs, std::abs(signal.error.back()));
    signal.mean += signal.error.back() / double(n);
    around_mean.push_back(signal.measured[i] - mean);
  }
  signal.rmse = rms(signal.error);
  const double size = rms(signal.measured), spread = rms(around_mean);
  signal.relative_percent = size > 0 ? 100 * signal.rmse / size : 0;
  signal.fit_percent = spread > 0 ? 100 * (1 - signal.rmse / spread) : 0;
  // The rows of the record, which a run that ended early did not reach.
  if (hold_out_fraction > 0 && n == rows)
    signal.held_out_rmse =
        rms(std::span(signal.error).last(whole_between<size_t>(double(n) * hold_out_fraction, 0, n)));
}

void add_axes(Comparison& comparison, const Experiment& experiment) {
  for (const auto& [role, port] : experiment.roles.ports) {
    if (role != "position" && role != "velocity") continue;
    std::vector<double> values;
    std::string source = "simulated", unit;
    for (const ComparedSignal& signal : comparison.signals)
      if (signal.name == port && signal.rows.are_all())
        values = signal.measured, source = "measured", unit = signal.unit;
    if (const Column* column = comparison.run.recording.find(port); column && values.empty())
      values = at_times(comparison.run.recording, *column, comparison.time), unit = column->unit;
    (role == "position" ? comparison.position : comparison.velocity) = values;
    (role == "position" ? comparison.position_unit : comparison.velocity_unit) = unit;
    (role == "position" ? comparison.position_source : comparison.velocity_source) = source;
  }
}

/// Over the rows that were recorded.
double rms_difference(const std::vector<double>& position, const MeasuredMotion& motion) {
  std::vector<double> difference;
  for (size_t k = 0; k < std::min(position.size(), motion.rows()); ++k)
    if (!motion.is_missing(k)) difference.push_back(position[k] - motion.position[k]);
  return rms(difference);
}

OpenLoopErrors open_loop_errors(const Machine& machine) {
  OpenLoopErrors errors;
  const auto error = [&](size_t horizon) {
    return rms_difference(simulate_position(machine, horizon), machine.motion);
  };
  errors.whole_record = error(0);
  for (double horizon : {0.05, 0.1, 0.2}) {
    const auto samples = whole_count(std::round(horizon / machine.motion.sample_time));
    if (samples >= 2) errors.restarted.emplace_back(horizon, error(samples));
  }
  return errors;
}

/// The nominal damping, from the decrease of the model's acceleration with speed.
double damping_of(const Machine& machine, const std::vector<double>& acceleration) {
  const MeasuredMotion& m = machine.motion;
  double fv = 0, vv = 0;
  for (size_t k = 0; k < m.rows(); ++k) {
    if (!m.counts[k]) continue;
    fv += (m.force[k] - machine.mass * acceleration[k]) * m.velocity[k], vv += m.velocity[k] * m.velocity[k];
  }
  return vv > 0 ? std::max(fv / vv, 0.0) : 0;
}

void analyse_force(Comparison& comparison, const std::string& diagram, const Experiment& experiment,
                   const LoadOptions& options) {
  comparison.is_closed_loop = std::ranges::none_of(experiment.drives, [&](const RecordedSignal& drive) {
    return std::ranges::any_of(experiment.roles.ports, [&](const auto& role) {
      return role.first == "input" && role.second == drive.port;
    });
  });
  auto machine = find_machine(diagram, experiment, options, comparison.why_no_force);
  if (!machine) return;
  const std::vector<double> acceleration = model_acceleration(*machine);
  if (machine->mass <= 0) {
    comparison.why_no_force = "the role \"force\" is not what accelerates the machine in the model";
    return;
  }
  if (std::ranges::none_of(machine->motion.counts, [](auto counts) { return bool(counts); })) {
    comparison.why_no_force =
        "no row counts: the axis is always near a rest, or rows are missing in the neighbourhood of each";
    return;
  }
  ForceAnalysis analysis;
  analysis.mass = machine->mass;
  analysis.residual = force_residual(*machine, acceleration);
  analysis.where = where_it_lies(*machine, analysis.residual);
  analysis.dependence = dependences(*machine, analysis.residual);
  analysis.open_loop = open_loop_errors(*machine);
  double resolution = 0;
  for (const RecordedSignal& signal : experiment.compared) {
    const bool is_position = std::ranges::any_of(experiment.roles.ports, [&](const auto& role) {
      return role.first == "position" && role.second == signal.port;
    });
    if (is_position) resolution = signal.resolution;
  }
  analysis.content = content_of(*machine, analysis.residual, resolution);
  analysis.content.sizes.machine_damping = damping_of(*machine, acceleration);
  Problems problems;
  analysis.identifiable = identifiable(analysis.content, load_catalogue({catalogue_folder()}, problems));
  for (const Problem& problem : problems.list()) comparison.warnings.push_back(to_string(problem));
  analysis.faults = faults_of(*machine, analysis.residual, analysis.content);
  analysis.motion = std::move(machine->motion);
  comparison.force = std::move(analysis);
}

/// `load` reads the diagram with the options that make it follow the experiment.
template <class Load>
Comparison compare_signals_of(const std::string& diagram_path, const Experiment& recorded,
                              const LoadOptions& options, const RunOptions& run_options, Load&& load) {
  Problems problems;
  const auto diagram = load(follow(recorded, options), problems);
  const auto plan = diagram ? compile(*diagram, problems) : nullptr;
  if (!plan) explain_failure(diagram_path, {recorded.path}, options, std::move(problems));
  const Experiment experiment = in_units_of_ports(*plan, recorded);
  Comparison comparison;
  comparison.diagram = diagram;
  comparison.plan = std::make_shared<Plan>(logging(*plan, experiment, problems));
  if (problems.has_errors()) throw InputError(std::move(problems));
  for (const Problem& problem : problems.list()) comparison.warnings.push_back(to_string(problem));
  comparison.run = simulate(*comparison.plan, run_options);
  for (const std::string& warning : comparison.run.warnings) comparison.warnings.push_back(warning);
  comparison.missing_samples = experiment.time.missing;
  comparison.time = experiment.data.columns.front().values;
  for (const RecordedSignal& compared : experiment.compared) {
    const Column& measured = *experiment.data.find(compared.port);
    ComparedSignal signal;
    signal.name = compared.port, signal.unit = measured.unit, signal.resolution = compared.resolution;
    signal.rows = compared.rows, signal.measured = picked(compared.rows, measured.values);
    signal.simulated = at_times(comparison.run.recording, *comparison.run.recording.find(compared.port),
                                picked(compared.rows, comparison.time));
    measure(signal, experiment.hold_out_fraction);
    comparison.signals.push_back(std::move(signal));
  }
  const size_t reached = reached_rows(comparison.run.recording, comparison.time);
  comparison.lacks_held_out = experiment.hold_out_fraction > 0 && reached < comparison.time.size();
  comparison.time.resize(reached);
  add_axes(comparison, experiment);
  return comparison;
}

}  // namespace

Comparison compare_signals(const std::string& diagram_path, const Experiment& experiment,
                           const LoadOptions& options, const RunOptions& run_options) {
  return compare_signals_of(diagram_path, experiment, options, run_options,
                            [&](const LoadOptions& following, Problems& problems) {
                              return load_diagram(diagram_path, following, problems);
                            });
}

Comparison compare_signals(const std::shared_ptr<const SourceFile>& diagram, const Experiment& experiment,
                           const LoadOptions& options, const RunOptions& run_options) {
  return compare_signals_of(diagram->name, experiment, options, run_options,
                            [&](const LoadOptions& following, Problems& problems) {
                              return load_diagram_text(diagram, following, problems);
                            });
}

Comparison compare(const std::string& diagram_path, const std::string& experiment_path,
                   const LoadOptions& options, const RunOptions& run_options) {
  Problems problems;
  const auto experiment = load_experiment(experiment_path, problems);
  if (experiment) reject_map(*experiment, problems);
  if (!experiment || problems.has_errors())
    explain_failure(diagram_path, {experiment_path}, options, std::move(problems));
  Comparison comparison = compare_signals(diagram_path, *experiment, options, run_options);
  analyse_force(comparison, diagram_path, in_units_of_ports(*comparison.plan, *experiment), options);
  return comparison;
}

}  // namespace loopwright
