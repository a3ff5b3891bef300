#include "tools/diagnose/record/axis_record.h"
#include "models/real/whole.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "tools/experiment/even_grid.h"

namespace loopwright::diagnosis {
namespace {

/// Port and index of a role. Reports a problem if the experiment lacks a required role.
const std::string* role_port(const Experiment& experiment, std::string_view role, Place* place) {
  for (size_t i = 0; i < experiment.roles.ports.size(); ++i)
    if (experiment.roles.ports[i].first == role) {
      if (place) *place = experiment.roles.places[i];
      return &experiment.roles.ports[i].second;
    }
  return nullptr;
}

Number number_of_role(const Experiment& experiment, const Plan& plan, std::string_view role,
                      Problems& problems) {
  Place place;
  const std::string* port = role_port(experiment, role, &place);
  if (!port) return -1;
  const std::vector<Number> numbers = plan.find(*port);
  if (numbers.size() == 1) return numbers[0];
  auto& p = problems.error(place, fmt::format("/roles/{}", role), "",
                           fmt::format("the role \"{}\" names no single signal", role));
  p.found = *port;
  std::vector<std::string> names;
  for (const Plan::Port& known : plan.ports) names.emplace_back(known.name);
  const std::string near = nearest_name(*port, names);
  if (!near.empty()) p.hint = "did you mean \"" + near + "\"?";
  return -1;
}

}  // namespace

MeasuredMotion measured_motion(const AxisRecord& record) {
  MeasuredMotion m;
  m.start = record.start, m.sample_time = record.sample_time, m.input = record.input;
  m.input_unit = record.input_unit, m.missing = record.missing;
  for (size_t k = 0; k < record.rows(); ++k) m.time.push_back(record.start + double(k) * record.sample_time);
  if (const MeasuredPort* position = record.find("position"))
    m.raw_position = position->value;
  else
    m.velocity = record.find("velocity")->value;
  smooth_motion(m);
  return m;
}

Experiment cut_open(const Experiment& experiment, const Plan& plan, Problems& problems) {
  Experiment cut = experiment;
  cut.drives.clear(), cut.drive_is_linear.clear();
  Place place;
  const std::string* port = role_port(experiment, "input", &place);
  if (!port) {
    problems.error(experiment.place, "/roles", "", "no role \"input\"").expected =
        "\"roles\": {\"input\": the port that the recorded force, current or voltage drives, …}";
    return cut;
  }
  const Number wanted = number_of_role(experiment, plan, "input", problems);
  const auto take = [&](const RecordedSignal& signal, bool linear) {
    const std::vector<Number> numbers = plan.find(signal.port);
    if (!cut.drives.empty() || numbers.size() != 1 || numbers[0] != wanted) return;
    cut.drives.push_back(signal);
    cut.drives.back().port = *port;
    cut.drive_is_linear.push_back(linear);
    if (signal.port == *port) return;
    Column column = *experiment.data.find(signal.port);
    column.name = *port;
    if (!cut.data.find(*port)) cut.data.columns.push_back(std::move(column));
  };
  for (size_t i = 0; i < experiment.drives.size(); ++i)
    take(experiment.drives[i], experiment.drive_is_linear[i]);
  for (const RecordedSignal& signal : experiment.compared) take(signal, false);
  if (cut.drives.empty() && wanted >= 0) {
    auto& p =
        problems.error(place, "/roles/input", "", fmt::format("the input \"{}\" was not recorded", *port));
    p.expected = "a column in \"drive\" or \"compare\" for the port of this role";
  }
  return cut;
}

AxisRecord read_axis_record(const Experiment& experiment, const Plan& plan, Problems& problems) {
  AxisRecord record;
  record.title = experiment.title, record.path = experiment.path, record.place = experiment.place;
  const std::vector<double>& time = experiment.data.columns.front().values;
  if (experiment.drives.empty() || time.size() < 2) return record;
  if (const std::string why = too_many_missing(experiment); !why.empty()) {
    problems.error(experiment.place, "/data", "", why);
    return record;
  }
  const EvenGrid grid(experiment);
  record.start = grid.start(), record.sample_time = grid.sample_time(), record.missing = grid.missing();
  const Column& input = *experiment.data.find(experiment.drives.front().port);
  record.input = grid.held(input.values);
  record.input_unit = input.unit;
  record.is_map = experiment.is_map;
  for (const char* role : {"position", "velocity"}) {
    const Number wanted = number_of_role(experiment, plan, role, problems);
    if (wanted < 0) continue;
    for (const RecordedSignal& signal : experiment.compared) {
      const std::vector<Number> numbers = plan.find(signal.port);
      if (numbers.size() != 1 || numbers[0] != wanted || record.find(role)) continue;
      const Column& column = *experiment.data.find(signal.port);
      const auto written = parse_unit(signal.unit);  // rad, not 1
      const std::string unit = written && written->scale == 1 ? signal.unit : column.unit;
      record.measured.push_back({role, wanted, unit, signal.resolution, grid.measured(column.values)});
    }
  }
  record.held_out_from = whole_between<size_t>(
      std::round(double(record.rows()) * (1 - experiment.hold_out_fraction)), 0, record.rows());
  if (record.measured.empty())
    problems.error(experiment.place, "/compare", "", "neither position nor velocity of the axis was recorded")
        .expected = "a column in \"compare\" for the port of the role \"position\" or \"velocity\"";
  return record;
}

}  // namespace loopwright::diagnosis
