#include "tools/linearize/measured_response.h"
#include <fmt/format.h>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include "engine/json/reader.h"
#include "models/real/whole.h"

namespace loopwright {
namespace {

using std::numbers::pi;

Value number(double x) {
  Value value;
  value.kind = Value::Kind::number;
  value.number = x;
  return value;
}

std::string unused_name(std::string name, const Diagram& diagram) {
  while (std::ranges::find(diagram.blocks, name, &BlockEntry::name) != diagram.blocks.end()) name += '_';
  return name;
}

/// The wire of a port such as "sum.terms[1]"; null after a problem.
Wire* find_wire(Diagram& diagram, const std::string& port, Problems& problems) {
  const size_t dot = port.find('.'), bracket = port.find('[');
  KnownNames known;
  for (BlockEntry& block : diagram.blocks)
    for (PortWires& wires : block.in) {
      const std::string name = block.name + "." + wires.port;
      for (size_t i = 0; i < wires.wires.size(); ++i)
        if ((wires.wires.size() == 1 && name == port) || fmt::format("{}[{}]", name, i) == port)
          return &wires.wires[i];
      known.add(name);
    }
  Problem& problem = problems.error({}, "", "", fmt::format("no signal can be added to \"{}\"", port));
  problem.expected = "an input port of an outermost block that is wired, with [i] where it has several wires";
  known.explain(problem, dot == port.npos ? port : port.substr(0, bracket));
  return nullptr;
}

/// Amplitude of the component of `y` at e^(jωt), after subtracting mean and linear drift.
std::complex<double> amplitude_at(double frequency, const std::vector<double>& time,
                                  const std::vector<double>& y) {
  Eigen::MatrixXd base(Eigen::Index(y.size()), 4);
  for (size_t i = 0; i < y.size(); ++i) {
    const double t = time[i];
    base.row(Eigen::Index(i)) << std::cos(frequency * t), std::sin(frequency * t), 1, t - time[0];
  }
  const Eigen::VectorXd fit =
      base.colPivHouseholderQr().solve(Eigen::Map<const Eigen::VectorXd>(y.data(), Eigen::Index(y.size())));
  return {fit[0], -fit[1]};  // a cos ωt + b sin ωt = Re (a - jb) e^(jωt)
}

class SineExperiment {
 public:
  SineExperiment(const Diagram& diagram, const SineTest& test, const RunOptions& options)
      : diagram_(diagram), test_(test), options_(options) {}

  MeasuredPoint at(double wanted) {
    const double shortest = test_.periods * 2 * pi / wanted;
    const double rows = std::max(16.0, std::ceil(shortest / test_.sample_time));
    const double window = rows * test_.sample_time;
    const double frequency = std::max(1.0, std::round(wanted * window / (2 * pi))) * 2 * pi / window;
    std::vector<double> time, up = output(frequency, test_.amplitude, window, time),
                              down = output(frequency, -test_.amplitude, window, time);
    for (size_t i = 0; i < up.size(); ++i) up[i] = 0.5 * (up[i] - down[i]);
    // The sine sin ωt is Re -j e^(jωt).
    const std::complex<double> into(0, -test_.amplitude);
    return {frequency, amplitude_at(frequency, time, up) / into};
  }

 private:
  std::vector<double> output(double frequency, double amplitude, double window, std::vector<double>& time) {
    BlockEntry source;
    source.name = "added_sine";
    source.type = "Sine";
    if (test_.holds) source.sample_time = number(test_.sample_time);
    source.settings.kind = Value::Kind::object;
    source.settings.members = {{"amplitude", {}, number(amplitude)},
                               {"frequency", {}, number(frequency / (2 * pi))}};
    Problems problems;
    Diagram tested = with_added_signal(diagram_, test_.from, source, problems);
    const double stop = std::ceil(test_.settle / test_.sample_time) * test_.sample_time + window;
    tested.solver.stop.value = stop, tested.solver.stop.is_given = true;
    tested.solver.record_step.value = test_.sample_time, tested.solver.record_step.is_given = true;
    tested.log = {{test_.to, {}}};
    const auto plan = problems.has_errors() ? nullptr : compile(tested, problems);
    if (!plan) throw InputError(std::move(problems));
    const RunResult result = simulate(*plan, options_);
    if (result.status != RunStatus::finished) throw std::runtime_error(result.message);
    const auto& columns = result.recording.columns;
    const auto rows = whole_between<std::ptrdiff_t>(std::round(window / test_.sample_time), 0,
                                                    std::ptrdiff_t(columns[0].values.size()) - 1);
    const auto last = [&](const Column& column) {  // without the last row, which repeats the first one
      return std::vector<double>(column.values.end() - 1 - rows, column.values.end() - 1);
    };
    time = last(columns[0]);
    return last(columns[1]);
  }

  const Diagram& diagram_;
  const SineTest& test_;
  const RunOptions& options_;
};

}  // namespace

Diagram with_added_signal(const Diagram& diagram, const std::string& port, const BlockEntry& source,
                          Problems& problems) {
  Diagram result = diagram;
  Wire* wire = find_wire(result, port, problems);
  if (!wire) return result;
  BlockEntry added = source, sum;
  added.name = unused_name(source.name, result);
  added.place = added.type_place = wire->place;
  sum.name = unused_name(added.name + "_sum", result);
  sum.type = "Sum";
  sum.place = sum.type_place = wire->place;
  sum.settings.kind = Value::Kind::object;
  sum.in = {{"terms", wire->place, true, {*wire, {added.name + ".y", wire->place}}}};
  wire->source = sum.name + ".sum";
  result.blocks.push_back(std::move(added));
  result.blocks.push_back(std::move(sum));
  return result;
}

std::vector<MeasuredPoint> measure_response(const Diagram& diagram, const SineTest& test,
                                            const RunOptions& options) {
  SineExperiment experiment(diagram, test, options);
  std::vector<MeasuredPoint> points;
  for (double frequency : test.frequencies) points.push_back(experiment.at(frequency));
  return points;
}

}  // namespace loopwright
