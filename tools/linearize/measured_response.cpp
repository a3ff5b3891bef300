#include "tools/linearize/measured_response.h"
#include <fmt/format.h>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include "engine/run/require_finished.h"
#include "models/real/whole.h"
#include "tools/linearize/changed_diagram.h"
#include "tools/linearize/linear_diagram.h"
#include "tools/linearize/ports.h"

namespace loopwright {
namespace {

using std::numbers::pi;

/// The number that an input port of an outermost block reads, as in the linear system; -1 after a problem. A
/// wire may carry several numbers, and an output may have the name of an input: a sine would be added
/// elsewhere.
Number number_read(const Plan& plan, const Diagram& diagram, const std::string& port, Problems& problems) {
  const auto found = find_port(plan, port, problems);
  if (found.empty()) return -1;
  const std::string whole = port.substr(0, port.find('['));
  const PortWires* const wires = wires_into(diagram, whole);
  if (found[0].is_output && wires) {
    auto& p = problems.error({}, "", "", fmt::format("\"{}\" is an output here", port));
    p.expected = "an input port of an outermost block";
    p.hint =
        fmt::format("the input of this name is \"{}.in.{}\"", whole.substr(0, whole.find('.')), wires->port);
    return -1;
  }
  const size_t numbers = wires ? find_port(plan, whole, problems).size() : 1;
  if (found.size() == 1 && (!wires || numbers == wires->wires.size())) return found[0].number;
  auto& p =
      problems.error({}, "", "", fmt::format("a simulated measurement needs one number at \"{}\"", port));
  p.expected = "a port with one number on each of its wires";
  p.found =
      fmt::format("{} numbers on {} {}", wires ? numbers : found.size(), wires ? wires->wires.size() : 1,
                  wires && wires->wires.size() != 1 ? "wires" : "wire");
  p.hint =
      "an index chooses one of several wires, as in sum.terms[0]; of a vector no single number can be driven";
  return -1;
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

/// The diagram with the ports of `open` cut at the operating point.
class OperatingPoint {
 public:
  OperatingPoint(const Diagram& diagram, const SineTest& test, const RunOptions& options)
      : diagram_(diagram) {
    Problems problems;
    const auto plan = compile(diagram, problems);
    if (!plan) throw InputError(std::move(problems));
    std::vector<Number> cut;
    number_read(*plan, diagram, test.from, problems);
    for (const std::string& port : test.open) cut.push_back(number_read(*plan, diagram, port, problems));
    if (problems.has_errors()) throw InputError(std::move(problems));
    start_ = plan->clock.time(plan->start_tick);
    if (!test.at && test.open.empty()) return;
    const LinearDiagram linear = test.at ? linearize_at(*plan, *test.at, options) : linearize_at_start(*plan);
    if (test.at) time_ = start_ = linear.time;
    for (size_t i = 0; i < cut.size(); ++i)
      diagram_ =
          with_cut_port(diagram_, test.open[i], linear.operating_point[size_t(cut[i])], time_, problems);
    if (problems.has_errors()) throw InputError(std::move(problems));
  }
  const Diagram& diagram() const { return diagram_; }
  std::optional<double> time() const { return time_; }  ///< s; none: the start
  double start() const { return start_; }               ///< s, of the sine

 private:
  Diagram diagram_;
  std::optional<double> time_;
  double start_ = 0;
};

class SineExperiment {
 public:
  SineExperiment(const Diagram& diagram, const SineTest& test, const RunOptions& options)
      : point_(diagram, test, options), test_(test), options_(options) {}

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
    BlockEntry source =
        block_with("added_sine", "Sine", {{"amplitude", amplitude}, {"frequency", frequency / (2 * pi)}});
    if (test_.holds) {
      Value period;
      period.kind = Value::Kind::number, period.number = test_.sample_time;
      source.sample_time = period;
    }
    Problems problems;
    Diagram tested = with_added_signal(point_.diagram(), test_.from, source, problems, point_.time());
    const double T = test_.sample_time, first_row = tested.solver.start.value;
    const double stop = first_row + std::ceil((point_.start() - first_row + test_.settle) / T) * T + window;
    tested.solver.stop.value = stop, tested.solver.stop.is_given = true;
    tested.solver.record_step.value = test_.sample_time, tested.solver.record_step.is_given = true;
    tested.log = {{test_.to, {}}};
    const auto plan = problems.has_errors() ? nullptr : compile(tested, problems);
    if (!plan) throw InputError(std::move(problems));
    const RunResult result = simulate(*plan, options_);
    require_finished(result);
    const auto& columns = result.recording.columns;
    const auto rows = whole_between<std::ptrdiff_t>(std::round(window / test_.sample_time), 0,
                                                    std::ptrdiff_t(columns[0].values.size()) - 1);
    const auto last = [&](const Column& column) {  // without the last row, which repeats the first one
      return std::vector<double>(column.values.end() - 1 - rows, column.values.end() - 1);
    };
    time = last(columns[0]);
    return last(columns[1]);
  }

  const OperatingPoint point_;
  const SineTest& test_;
  const RunOptions& options_;
};

}  // namespace

std::vector<MeasuredPoint> measure_response(const Diagram& diagram, const SineTest& test,
                                            const RunOptions& options) {
  SineExperiment experiment(diagram, test, options);
  std::vector<MeasuredPoint> points;
  for (double frequency : test.frequencies) points.push_back(experiment.at(frequency));
  return points;
}

}  // namespace loopwright
