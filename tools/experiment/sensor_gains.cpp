#include "tools/experiment/sensor_gains.h"
#include <algorithm>
#include <cmath>
#include "engine/run/run.h"

namespace loopwright {
namespace {

struct Reading {
  Number number = -1;  ///< what the Gains read
  double gain = 1;     ///< of all of them
};

class Sensors {
 public:
  explicit Sensors(const Plan& plan) : plan_(plan), run_(plan) {}

  /// The number behind all Gains, or behind as many as lead to `wanted`.
  Reading behind(Number number, Number wanted = -1) {
    Reading reading{number};
    while (reading.number >= 0 && reading.number != wanted) {
      const int source = plan_.source_of(reading.number).first;
      if (source < 0) break;
      const Plan::Block& block = plan_.blocks[size_t(source)];
      const double* gain = block.type->info.type == "Gain" ? run_.parameter(block.path + ".gain") : nullptr;
      if (!gain || *gain == 0 || !std::isfinite(*gain) || block.inputs[0].size() != 1) break;
      reading.gain *= *gain, reading.number = block.inputs[0][0];
    }
    return reading;
  }
  Number number_of(const std::string& port) const {
    const std::vector<Number> numbers = plan_.find(port);
    return numbers.size() == 1 ? numbers[0] : -1;
  }
  /// The shortest of its names; empty: it has none.
  std::string name_of(Number number) const {
    std::string shortest;
    for (const Plan::Port& port : plan_.ports)
      if ((shortest.empty() || port.name.size() < shortest.size()) &&
          number_of(std::string(port.name)) == number)
        shortest = port.name;
    return shortest;
  }
  bool differ_in_dimension(Number a, Number b) const {
    const auto of_a = plan_.unit_of(a), of_b = plan_.unit_of(b);
    return of_a && of_b && !of_a->same_dimension(*of_b);
  }

 private:
  const Plan& plan_;
  Run<double> run_;
};

/// The column of a compared signal as that of another port.
void move_to(Experiment& experiment, RecordedSignal& signal, const std::string& port, double gain,
             const std::optional<Unit>& unit) {
  for (Column& column : experiment.data.columns) {
    if (column.name != signal.port) continue;
    for (double& value : column.values) value /= gain;
    column.name = port;
    if (unit) column.unit = to_string(unit->in_si());
  }
  signal.port = port, signal.resolution /= std::abs(gain);
  if (unit) signal.unit = to_string(unit->in_si());
}

}  // namespace

Experiment without_sensor_gains(const Plan& plan, Experiment experiment) {
  Sensors sensors(plan);
  for (auto& [role, port] : experiment.roles.ports) {
    if (role != "position" && role != "velocity") continue;
    Number wanted = sensors.number_of(port);
    if (wanted < 0) continue;
    if (const Number read = sensors.behind(wanted).number; sensors.differ_in_dimension(wanted, read))
      if (std::string name = sensors.name_of(read); !name.empty()) port = std::move(name), wanted = read;
    const auto number_of = [&](const RecordedSignal& s) { return sensors.number_of(s.port); };
    if (std::ranges::find(experiment.compared, wanted, number_of) != experiment.compared.end()) continue;
    for (RecordedSignal& signal : experiment.compared) {
      const Reading reading = sensors.behind(number_of(signal), wanted);
      if (reading.number != wanted) continue;
      move_to(experiment, signal, port, reading.gain, plan.unit_of(wanted));
      break;
    }
  }
  return experiment;
}

}  // namespace loopwright
