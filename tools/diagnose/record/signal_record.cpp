#include "tools/diagnose/record/signal_record.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include "models/real/whole.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/record/dead_sensor.h"
#include "tools/diagnose/record/shorten.h"
#include "tools/experiment/false_readings.h"

namespace loopwright::diagnosis {
namespace {

/// Fewer rows support no verdict: intervals and criteria rest on large numbers.
constexpr size_t fewest_rows = 200;
/// More take minutes, because the search passes over the record thousands of times.
constexpr size_t most_rows = 50'000;

double median_step(const std::vector<double>& time) {
  std::vector<double> steps;
  for (size_t k = 1; k < time.size(); ++k) steps.push_back(time[k] - time[k - 1]);
  const auto middle = steps.begin() + std::ptrdiff_t(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

}  // namespace

std::vector<bool> SignalRecord::settling_rows() const {
  std::vector<bool> settles(rows());
  for (size_t from = 0, to = 0; from < rows(); from = to) {
    do ++to;
    while (to < rows() && !begins_at(to));
    std::fill_n(settles.begin() + std::ptrdiff_t(from), (to - from) / criteria::settling_part, true);
  }
  return settles;
}

size_t SignalRecord::fitted_rows() const {
  size_t count = 0;
  for (size_t row = 0; row < held_out_from; ++row)
    count +=
        std::ranges::any_of(outputs, [&](const RecordedOutput& o) { return std::isfinite(o.value[row]); });
  return count;
}

SignalRecord read_signal_record(const Experiment& experiment, Problems& problems) {
  SignalRecord record;
  record.title = experiment.title, record.path = experiment.path;
  record.time = experiment.data.columns.front().values;
  if (record.time.size() < fewest_rows) {
    auto& p = problems.error(experiment.place, "/data", "", "too few rows for a diagnosis");
    p.expected = fmt::format("at least {} rows", fewest_rows);
    p.found = fmt::format("{}", record.time.size());
    return record;
  }
  record.sample_time = median_step(record.time);
  for (const RecordedSignal& drive : experiment.drives)
    if (const Column* column = experiment.data.find(drive.port))
      record.inputs.push_back({drive.port, column->unit, drive.between_rows, column->values});
  for (const RecordedSignal& compared : experiment.compared) {
    const Column* column = experiment.data.find(compared.port);
    if (!column) continue;
    reject_if_constant(compared, *column, problems);
    record.outputs.push_back({compared.port, column->unit, compared.resolution, column->values});
    if (column->unit == "rad") record.outputs.back().leaps_by_a_turn = leaps_by_a_turn(column->values);
    for (const size_t row : false_readings(column->values)) {
      record.outputs.back().value[row] = std::numeric_limits<double>::quiet_NaN();
      ++record.false_readings;
    }
  }
  record.held_out_from = whole_between<size_t>(
      std::round(double(record.rows()) * (1 - experiment.hold_out_fraction)), 0, record.rows());
  return record;
}

void reject_too_few(const SignalRecord& record, Problems& problems) {
  if (problems.has_errors() || record.fitted_rows() >= fewest_rows) return;
  auto& p = problems.error({}, "/hold_out", "", "too few rows are left to fit");
  p.expected = fmt::format("at least {} rows in which something was measured", fewest_rows);
  p.found = fmt::format("{} in {}", record.fitted_rows(), record.path);
}

SignalRecord joined(std::vector<SignalRecord> records, Problems& problems) {
  const std::optional<RecordFinding> shortened = shorten(records, most_rows);
  SignalRecord all = records.front();
  all.shortened = shortened;
  all.false_readings = 0;
  for (const SignalRecord& record : records) all.false_readings += record.false_readings;
  if (records.size() > 1) {
    const auto ports = [](const SignalRecord& record) {
      std::vector<std::string> list;
      for (const RecordedInput& input : record.inputs) list.push_back(input.port);
      for (const RecordedOutput& output : record.outputs) list.push_back(output.port);
      return list;
    };
    all.time.clear(), all.begins.clear();
    for (RecordedInput& input : all.inputs) input.value.clear();
    for (RecordedOutput& output : all.outputs) output.value.clear();
    const auto append = [&](size_t number, size_t from, size_t to) {
      const SignalRecord& record = records[number];
      const auto copy = [&](const std::vector<double>& part, std::vector<double>& whole) {
        whole.insert(whole.end(), part.begin() + std::ptrdiff_t(from), part.begin() + std::ptrdiff_t(to));
      };
      for (size_t row = from; row < to; ++row)
        all.begins.push_back(row == from), all.of_record.push_back(number);
      copy(record.time, all.time);
      for (size_t i = 0; i < all.inputs.size(); ++i) copy(record.inputs[i].value, all.inputs[i].value);
      for (size_t j = 0; j < all.outputs.size(); ++j) copy(record.outputs[j].value, all.outputs[j].value);
    };
    for (const SignalRecord& record : records)
      if (ports(record) != ports(records.front())) {
        auto& p = problems.error({}, "/compare", "", "the records do not drive and compare the same ports");
        p.expected = "those of " + records.front().path + ", in the same order", p.found = record.path;
        return all;
      }
    for (size_t r = 0; r < records.size(); ++r) append(r, 0, records[r].held_out_from);
    all.held_out_from = all.rows();
    for (size_t r = 0; r < records.size(); ++r) append(r, records[r].held_out_from, records[r].rows());
  }
  reject_too_few(all, problems);
  return all;
}

}  // namespace loopwright::diagnosis
