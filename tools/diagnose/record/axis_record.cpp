#include "tools/diagnose/record/axis_record.h"
#include "models/real/whole.h"
#include "engine/record/excerpt.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/record/dead_sensor.h"
#include "tools/experiment/even_grid.h"
#include "tools/experiment/false_readings.h"

namespace loopwright::diagnosis {
namespace {

constexpr size_t fewest_rows_of_motion = 3;  // of a motion: its acceleration needs so many

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

/// Of a long record every so many rows are measurements. Between them the input keeps its mean and its first
/// moment, which is all that the next position of a mass depends on.
void thin(AxisRecord& record, size_t every) {
  const std::vector<double> input = std::move(record.input), slope = std::move(record.input_slope);
  const size_t rows = input.size() / every;
  record.input.assign(rows, 0), record.input_slope.assign(rows, 0);
  const double share = 1 / double(every);
  for (size_t k = 0; k < rows; ++k)
    for (size_t i = 0; i < every; ++i) {
      const double from_middle = (double(i) + 0.5) * share - 0.5;
      record.input[k] += share * input[k * every + i];
      record.input_slope[k] += 12 * share * from_middle * input[k * every + i];
      if (!slope.empty()) record.input_slope[k] += share * share * slope[k * every + i];
    }
  const auto keep = [&](auto& list) {
    for (size_t k = 0; k < rows; ++k) list[k] = list[k * every];
    list.resize(rows);
  };
  if (!record.missing.empty()) {
    for (size_t k = 0; k < rows; ++k)
      for (size_t i = 1; i < every; ++i) record.missing[k * every] |= record.missing[k * every + i];
    keep(record.missing);
  }
  for (MeasuredPort& port : record.measured) keep(port.value);
  if (!record.false_rows.empty()) keep(record.false_rows);
  record.sample_time *= double(every), record.is_thinned = true;
}

/// The samples before the first reading are left out.
void begin_at(AxisRecord& record, size_t first) {
  const auto shorten = [&](auto& list) { list.erase(list.begin(), list.begin() + std::ptrdiff_t(first)); };
  shorten(record.input);
  if (!record.input_slope.empty()) shorten(record.input_slope);
  for (MeasuredPort& port : record.measured) shorten(port.value);
  record.start += double(first) * record.sample_time;
}

bool changes_between(const AxisRecord& record, const SlowerRows& rows) {
  if (!record.input_slope.empty()) return true;
  for (size_t k = rows.first + 1; k < record.input.size(); ++k)
    if ((k - rows.first) % rows.every != 0 && record.input[k] != record.input[k - 1]) return true;
  return false;
}

/// Samples are those of the sensor that is read most often. Another one is left out if it is read less often.
void take_rows_of_sensors(AxisRecord& record, Problems& problems) {
  if (record.measured.empty()) return;
  const SlowerRows rows =
      std::ranges::min(record.measured, {}, [](const MeasuredPort& port) { return port.rows.every; }).rows;
  std::erase_if(record.measured, [&](const MeasuredPort& port) {
    const bool is_other = port.rows != rows;
    if (is_other) record.left_out = port.role;
    return is_other;
  });
  if (rows.are_all()) return;
  if (!record.missing.empty() || !record.duration.empty()) {
    auto& p = problems.error(record.place, "/compare", "",
                             fmt::format("the {} of the axis has a reading in one of {} rows, and these are "
                                         "not evenly in time",
                                         record.measured.front().role, rows.every));
    p.expected = "rows of one sample time, none of them missing";
    p.hint = "or \"excerpt\", which picks the rows that have a reading";
    return;
  }
  record.acts_between_readings = changes_between(record, rows);
  begin_at(record, rows.first);
  thin(record, rows.every);
}

/// Means over `rows` rows about each one; of an even number, the one that is left over lies behind it.
/// Without weights, so that no reading counts in two rows that stand for several: its noise would be seen in
/// both.
std::vector<double> means_about(const std::vector<double>& values, size_t rows) {
  const auto before = std::ptrdiff_t((rows - 1) / 2), after = std::ptrdiff_t(rows / 2),
             size = std::ptrdiff_t(values.size());
  std::vector<double> means(values.size());
  for (std::ptrdiff_t k = 0; k < size; ++k) {
    const bool is_whole = k >= before && k + after < size;  // shorter at the ends of the record
    const std::ptrdiff_t shorter = std::min({before, k, size - 1 - k}), first = k - shorter,
                         last = is_whole ? k + after : k + shorter;
    double sum = 0;
    for (std::ptrdiff_t i = first; i <= last; ++i) sum += values[size_t(i)];
    means[size_t(k)] = sum / double(last - first + 1);
  }
  return means;
}

/// Before rows are put together: a linear plant answers the mean of its input by the mean of its position. If
/// single readings stood for many, a controller would know more than the record, and what it does about it
/// would look like a delay.
void take_means(AxisRecord& record, size_t rows) {
  record.rows_in_one = rows;
  record.input = means_about(record.input, rows);
  if (!record.input_slope.empty()) record.input_slope = means_about(record.input_slope, rows);
  for (MeasuredPort& port : record.measured) {
    port.value = means_about(port.value, rows);
    port.resolution /= std::sqrt(double(rows));
  }
}

/// The input as recorded; values that are not felt become what their neighbours say. Whatever it does between
/// its rows, a wrong value is seen in its own row.
std::vector<double> without_leaps(const std::vector<double>& time, std::vector<double> input,
                                  InputLeaps leaps, AxisRecord& record) {
  if (record.is_map) return input;
  const std::vector<size_t> rows = unfelt_rows(input, leaps == InputLeaps::felt ? InputLeaps::unfelt : leaps);
  record.leaps = leaps, record.input_leaps = rows.size();
  if (leaps != InputLeaps::felt) replace_readings(time, input, rows);
  return input;
}

/// A device that gives an old value now and then says nothing of the machine.
void replace_false_readings(AxisRecord& record) {
  if (record.is_map) return;
  const std::vector<double> at = places_of_rows(record);
  for (MeasuredPort& port : record.measured) {
    const std::vector<size_t> rows = false_readings(port.value);
    replace_readings(at, port.value, rows);
    record.false_readings += rows.size();
    if (!rows.empty()) record.false_rows.resize(record.rows());
    for (const size_t row : rows) record.false_rows[row] = 1;
  }
}

/// How many rows become one: see criteria.h.
size_t rows_for_one(const AxisRecord& record) {
  if (record.is_map || !record.duration.empty()) return 1;
  const double wanted = double(record.rows()) / criteria::most_rows,
               allowed = criteria::thinned_sample_s / record.sample_time;
  return std::max<size_t>(1, whole_count(std::floor(std::min(std::ceil(wanted), allowed))));
}

/// Σ wⁱ x[k ± i] over i = 0 … `reach`, for every row k; beyond its ends a record stays as it is there. Each
/// sum is made from that of its neighbour: what leaves it is taken away.
std::vector<double> weighted_sums(const std::vector<double>& values, double weight, size_t reach,
                                  bool ahead) {
  const size_t rows = values.size();
  const auto value = [&](size_t from_start) {  // in the direction of the sums
    return values[ahead ? rows - 1 - from_start : from_start];
  };
  const double left = std::pow(weight, double(reach) + 1);
  std::vector<double> sums(rows);
  double sum = 0;
  for (size_t i = 0; rows > 0 && i <= reach; ++i) sum = value(0) + weight * sum;
  for (size_t k = 0; k < rows; ++k) {
    if (k > 0) sum = value(k) + weight * sum - left * value(k > reach ? k - reach - 1 : 0);
    sums[ahead ? rows - 1 - k : k] = sum;
  }
  return sums;
}

}  // namespace

std::vector<double> mean_over_rows(const std::vector<double>& values, double rows, RowsOfMean side) {
  constexpr double widths = 5;  // beyond which the weights are below a hundredth
  const bool about = side == RowsOfMean::about;
  const double weight = std::exp(-1 / rows);
  const size_t reach = whole_count(std::ceil(widths * rows));
  std::vector<double> means = weighted_sums(values, weight, reach, true);
  double sum = 0;
  for (size_t i = 0; i <= reach; ++i) sum += std::pow(weight, double(i)) * (about && i > 0 ? 2 : 1);
  if (about) {
    const std::vector<double> behind = weighted_sums(values, weight, reach, false);
    for (size_t k = 0; k < means.size(); ++k) means[k] += behind[k] - values[k];
  }
  for (double& mean : means) mean /= sum;
  return means;
}

void take_noise_away(AxisRecord& record, const InputCorrection& noise) {
  if (noise.rows == 0) return;
  for (std::vector<double>* values : {&record.input, &record.input_slope}) {
    const std::vector<double> mean = mean_over_rows(*values, noise.rows);
    for (size_t k = 0; k < values->size(); ++k) (*values)[k] -= noise.share * ((*values)[k] - mean[k]);
  }
}

MeasuredMotion measured_motion(const AxisRecord& record) {
  MeasuredMotion m;
  m.start = record.start, m.sample_time = record.sample_time;
  m.input_unit = record.input_unit, m.missing = record.missing;
  for (size_t k = 0; k < record.rows(); ++k) m.time.push_back(record.start + double(k) * record.sample_time);
  m.input = mean_over_even_samples(record.input, record.duration);
  if (const MeasuredPort* position = record.find("position"))
    m.raw_position = at_even_instants(position->value, record.duration);
  else
    m.velocity = at_even_instants(record.find("velocity")->value, record.duration);
  smooth_motion(m);
  shift_position(m, record.first_position);
  return m;
}

Experiment cut_open(const Experiment& experiment, const Plan& plan, Problems& problems) {
  Experiment cut = experiment;
  cut.drives.clear();
  Place place;
  const std::string* port = role_port(experiment, "input", &place);
  if (!port) {
    problems.error(experiment.place, "/roles", "", "no role \"input\"").expected =
        "\"roles\": {\"input\": the port that the recorded force, current or voltage drives, …}";
    return cut;
  }
  const Number wanted = number_of_role(experiment, plan, "input", problems);
  const auto take = [&](const RecordedSignal& signal) {
    const std::vector<Number> numbers = plan.find(signal.port);
    if (!cut.drives.empty() || numbers.size() != 1 || numbers[0] != wanted) return;
    if (!signal.rows.are_all()) {
      problems
          .error(signal.place, signal.pointer, "",
                 fmt::format("the input was recorded in one of {} rows only", signal.rows.every))
          .expected = "a number in every row: what drives has a value at all times";
      return;
    }
    cut.drives.push_back(signal);
    cut.drives.back().port = *port;
    if (signal.port == *port) return;
    loopwright::Column column = *experiment.data.find(signal.port);
    column.name = *port;
    if (!cut.data.find(*port)) cut.data.columns.push_back(std::move(column));
  };
  for (const auto* list : {&experiment.drives, &experiment.compared})
    for (const RecordedSignal& signal : *list) take(signal);
  if (cut.drives.empty() && wanted >= 0) {
    auto& p =
        problems.error(place, "/roles/input", "", fmt::format("the input \"{}\" was not recorded", *port));
    p.expected = "a column in \"drive\" or \"compare\" for the port of this role";
  }
  return cut;
}

std::vector<double> places_of_rows(const AxisRecord& record) {
  std::vector<double> at(record.rows());
  for (size_t k = 1; k < at.size(); ++k)
    at[k] = at[k - 1] + (record.duration.empty() ? 1 : record.duration[k - 1]);
  return at;
}

AxisRecord read_axis_record(const Experiment& experiment, const Plan& plan, Problems& problems,
                            size_t rows_in_one, const InputCorrection& correction) {
  AxisRecord record;
  record.title = experiment.title, record.path = experiment.path, record.place = experiment.place;
  const std::vector<double>& time = experiment.data.columns.front().values;
  if (experiment.drives.empty()) return record;
  if (!experiment.is_map && time.size() < fewest_rows_of_motion) {
    problems.error(experiment.place, "/data", "", "too few rows for a diagnosis").expected =
        fmt::format("at least {} rows", fewest_rows_of_motion);
    return record;
  }
  if (const std::string why = too_many_missing(experiment); !why.empty()) {
    problems.error(experiment.place, "/data", "", why);
    return record;
  }
  const EvenGrid grid(experiment);
  record.start = grid.start(), record.sample_time = grid.sample_time(), record.missing = grid.missing();
  const RecordedSignal& drive = experiment.drives.front();
  const loopwright::Column& input = *experiment.data.find(drive.port);
  record.duration = grid.duration();
  record.is_map = experiment.is_map;  // its rows do not follow each other
  record.rows_late = correction.rows_late;
  OverSamples over = grid.driving(
      moved_earlier(without_leaps(time, input.values, correction.leaps, record), correction.rows_late),
      record.is_map ? BetweenRows::hold : drive.between_rows);
  record.input = std::move(over.mean), record.input_slope = std::move(over.change);
  record.input_unit = input.unit;
  for (const char* role : {"position", "velocity"}) {
    const Number wanted = number_of_role(experiment, plan, role, problems);
    if (wanted < 0) continue;
    for (const RecordedSignal& signal : experiment.compared) {
      const std::vector<Number> numbers = plan.find(signal.port);
      if (numbers.size() != 1 || numbers[0] != wanted || record.find(role)) continue;
      const loopwright::Column& column = *experiment.data.find(signal.port);
      if (!record.is_map) reject_if_constant(signal, column, problems);
      const auto written = parse_unit(signal.unit);  // rad, not 1
      const std::string unit = written && written->scale == 1 ? signal.unit : column.unit;
      if (!record.is_map && unit == "rad") record.leaps_by_a_turn = leaps_by_a_turn(column.values);
      record.measured.push_back(
          {role, wanted, unit, signal.resolution, grid.measured(column.values), signal.rows});
    }
  }
  take_rows_of_sensors(record, problems);
  replace_false_readings(record);
  if (rows_in_one == 0) rows_in_one = rows_for_one(record);
  if (rows_in_one > 1 && !record.is_map && record.duration.empty())
    take_means(record, rows_in_one), thin(record, rows_in_one);
  record.held_out_from = whole_between<size_t>(
      std::round(double(record.rows()) * (1 - experiment.hold_out_fraction)), 0, record.rows());
  if (record.measured.empty())
    problems.error(experiment.place, "/compare", "", "neither position nor velocity of the axis was recorded")
        .expected = "a column in \"compare\" for the port of the role \"position\" or \"velocity\"";
  return record;
}

}  // namespace loopwright::diagnosis
