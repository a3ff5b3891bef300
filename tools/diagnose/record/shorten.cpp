#include "tools/diagnose/record/shorten.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "models/real/whole.h"
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

size_t rows_of(const std::vector<SignalRecord>& records) {
  size_t rows = 0;
  for (const SignalRecord& record : records) rows += record.rows();
  return rows;
}

/// What an output does within `count` neighboring rows, to what it does at all, root mean squares; 1 if too
/// many of its readings are missing for means.
double averaged_away(const std::vector<double>& y, size_t count) {
  double sum = 0, square = 0, within = 0, readings = 0;
  for (size_t row = 0; row + count <= y.size(); row += count) {
    double mean = 0;
    for (size_t k = row; k < row + count; ++k) mean += y[k] / double(count);
    if (!std::isfinite(mean)) continue;
    for (size_t k = row; k < row + count; ++k)
      sum += y[k], square += y[k] * y[k], within += (y[k] - mean) * (y[k] - mean), ++readings;
  }
  const double about_mean = square - sum * sum / std::max(1.0, readings);
  if (readings < (1 - criteria::most_missing_of_means) * double(y.size()) || !(about_mean > 0)) return 1;
  return std::sqrt(within / about_mean);
}

double averaged_away(const std::vector<SignalRecord>& records, size_t count) {
  double most = 0;
  for (const SignalRecord& record : records)
    for (const RecordedOutput& output : record.outputs)
      most = std::max(most, averaged_away(output.value, count));
  return most;
}

/// A held input acts half a row later than its stamp: the mean over the time about the rows' own.
double mean_of_input(const RecordedInput& input, size_t first, size_t row, size_t count) {
  double sum = 0;
  for (size_t k = row; k < row + count; ++k)
    sum += input.between_rows == BetweenRows::hold
               ? 0.5 * (input.value[k] + input.value[k > first ? k - 1 : k])
               : input.value[k];
  return sum / double(count);
}

/// Appends means of the rows [from, to). None lies across a gap.
void append_means(const SignalRecord& record, size_t from, size_t to, size_t count, SignalRecord& thin) {
  constexpr double gap = 1.5;  // [time of as many rows]
  const auto mean = [&](const std::vector<double>& values, size_t row) {
    double sum = 0;
    for (size_t k = row; k < row + count; ++k) sum += values[k];
    return sum / double(count);
  };
  for (size_t row = from; row + count <= to;) {
    if (record.time[row + count - 1] - record.time[row] > gap * double(count) * record.sample_time) {
      ++row;
      continue;
    }
    thin.time.push_back(mean(record.time, row));
    for (size_t i = 0; i < record.inputs.size(); ++i)
      thin.inputs[i].value.push_back(mean_of_input(record.inputs[i], from, row, count));
    for (size_t j = 0; j < record.outputs.size(); ++j)
      thin.outputs[j].value.push_back(mean(record.outputs[j].value, row));
    row += count;
  }
}

/// The first `share` of the fitted rows and of those held out, as means of `count` rows.
SignalRecord shortened(const SignalRecord& record, size_t count, double share) {
  SignalRecord thin = record;
  thin.time.clear();
  for (RecordedInput& input : thin.inputs) input.value.clear();
  for (RecordedOutput& output : thin.outputs) output.value.clear();
  const size_t held_out = record.held_out_from, rows = record.rows();
  const auto part = [&](size_t of) { return whole_between<size_t>(share * double(of), 0, of); };
  append_means(record, 0, part(held_out), count, thin);
  thin.held_out_from = thin.rows();
  append_means(record, held_out, held_out + part(rows - held_out), count, thin);
  thin.sample_time = record.sample_time * double(count);
  for (RecordedOutput& output : thin.outputs) output.resolution /= std::sqrt(double(count));
  if (count > 1)
    for (RecordedInput& input : thin.inputs)
      if (input.between_rows == BetweenRows::hold) input.between_rows = BetweenRows::linear;
  if (share < 1 && thin.held_out_from > 0 && thin.held_out_from < thin.rows()) {
    thin.begins.assign(thin.rows(), false);
    thin.begins[0] = thin.begins[thin.held_out_from] = true;
  }
  return thin;
}

}  // namespace

std::optional<RecordFinding> shorten(std::vector<SignalRecord>& records, size_t most_rows) {
  const size_t rows = rows_of(records);
  if (rows <= most_rows) return {};
  size_t count = (rows + most_rows - 1) / most_rows;
  while (count > 1 && averaged_away(records, count) > criteria::most_averaged_away) --count;
  const double lost = count > 1 ? averaged_away(records, count) : 0;
  const double share = std::min(1.0, double(most_rows * count) / double(rows));
  for (SignalRecord& record : records) record = shortened(record, count, share);
  RecordFinding finding;
  finding.what = fmt::format("{} rows are more than a search can pass over thousands of times: ", rows);
  if (share < 1) finding.what += fmt::format("the first {:.3g} % of them are used", 100 * share);
  if (count > 1)
    finding.what += fmt::format("{}means of {} rows stand for them, {:.4g} ms apart",
                                share < 1 ? ", and " : "", count, 1e3 * records.front().sample_time);
  if (share < 1) finding.cost = "what happens later is not seen";
  if (count > 1)
    finding.cost += fmt::format(
        "{}of what is measured, {:.2g} % is faster and averaged away, and of faster "
        "inputs only the mean acts",
        share < 1 ? ", and " : "", 100 * lost);
  return finding;
}

}  // namespace loopwright::diagnosis
