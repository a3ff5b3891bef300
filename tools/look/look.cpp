#include "tools/look/look.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include "engine/json/problem.h"
#include "engine/json/unit_hint.h"
#include "engine/record/column_units.h"
#include "engine/record/recording_file.h"
#include "engine/record/time_axis.h"
#include "engine/record/time_names.h"
#include "engine/record/time_stamps.h"
#include "tools/experiment/signal_figures.h"

namespace loopwright {
namespace {

std::string counted(size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// "data.csv:3:5".
std::string place_of(const Problem& problem) {
  const LineColumn place = line_column(problem.place);
  return fmt::format("{}:{}:{}", problem.place.file->name, place.line, place.column);
}

/// "an empty cell in data.csv:3:5", "text where a number should be (ok) in data.csv:4:5".
std::string hole_text(const Column& column) {
  if (column.holes.first.empty()) return "";
  const Problem& hole = column.holes.first.front();
  const size_t colon = hole.message.rfind("\": ");  // behind the name of the column
  return hole.message.substr(colon == hole.message.npos ? 0 : colon + 3) +
         (hole.found.empty() ? "" : fmt::format(" ({})", hole.found)) + " in " + place_of(hole);
}

class Looker {
 public:
  explicit Looker(Look& look) : look_(look) {}

  void look_at_time(const std::string& name);
  void look_at_columns();
  void compare_columns();

 private:
  void find(std::string name, std::string text, std::string advice) {
    look_.findings.push_back({std::move(name), std::move(text), std::move(advice)});
  }
  bool question_growth(const Column& time);
  void question_choice(const Column& time, const std::string& name);
  void question_unit(const Column& raw);
  void measure_grid(LookedTime& time);
  void question_grid(const LookedTime& time);
  LookedColumn figures(const Column& column) const;
  void question(const LookedColumn& column);

  Look& look_;
};

void Looker::look_at_time(const std::string& name) {
  Problems own;
  const auto error = [&](std::string message) -> Problem& {
    return own.error({}, "", "", std::move(message));
  };
  const auto found = time_in_seconds(look_.recording, name, error);
  const bool grows = found && question_growth(*found);
  for (const Problem& problem : own.list()) {
    if (problem.severity != Problem::Severity::error) continue;
    const std::string place = problem.place.file ? " in " + place_of(problem) : "";
    std::string advice = problem.expected.empty() ? "" : "expected: " + problem.expected;
    if (!problem.hint.empty()) advice += (advice.empty() ? "" : "; ") + problem.hint;
    find("time_not_usable", problem.message + place, advice);
  }
  if (!found) return;
  const Column& raw = *look_.recording.find(found->name);
  question_choice(raw, name);
  if (!grows) return;
  LookedTime time;
  time.column = raw.name, time.unit = raw.unit, time.at = found->values;
  for (double& t : time.at) t += 0.0;  // -0 becomes 0
  if (time.at.size() > 1) measure_grid(time);
  look_.time = std::move(time);
  question_unit(raw);
  question_grid(*look_.time);
}

/// Whether the times increase from row to row.
bool Looker::question_growth(const Column& time) {
  size_t none = 0, again = 0, back = 0, first_back = 0, same = 0;
  for (size_t row = 0; row < time.values.size(); ++row) {
    const double now = time.values[row],
                 before = row > 0 ? time.values[row - 1] : -std::numeric_limits<double>::infinity();
    if (!std::isfinite(now)) ++none;
    if (now < before && back++ == 0) first_back = row;
    if (now != before) continue;
    ++again;
    same += std::ranges::all_of(look_.recording.columns, [&](const Column& column) {
      return column.values[row] == column.values[row - 1];
    });
  }
  if (none > 0)
    find("time_not_finite",
         fmt::format("the time \"{}\" has no number in {}", time.name, counted(none, "row")),
         "leave out these rows");
  if (back > 0)
    find("time_goes_back",
         fmt::format("the time \"{}\" goes back {}, first in row {} from {:.9g} to {:.9g} s", time.name,
                     counted(back, "time"), first_back + 1, time.values[first_back - 1],
                     time.values[first_back]),
         "two recordings in one file (an experiment's \"excerpt\" takes one of them by \"skip\"), a counter "
         "that wrapped "
         "around, or no time");
  if (again > 0)
    find("time_again",
         fmt::format("{} the time of the row before, {} of them with the same numbers",
                     again == 1 ? "1 row has" : fmt::format("{} rows have", again), same),
         same == again ? "readers read such rows once" : "stamps with too few digits, or no time");
  return none == 0 && back == 0 && again == 0 && !time.values.empty();
}

void Looker::question_choice(const Column& time, const std::string& name) {
  if (!name.empty() || is_called_time(last_part(time.name))) return;
  find("time_not_named",
       fmt::format("no column is called time: the first, \"{}\", is taken as the time", time.name),
       "name it: --time here, \"time\" in an experiment");
}

void Looker::question_unit(const Column& raw) {
  constexpr double slow = 0.5;        // s between rows: rare for a machine
  constexpr size_t least_rows = 100;  // to be asked about
  const LookedTime& time = *look_.time;
  if (!raw.unit.empty() || look_.rows < least_rows || time.sample_time < slow) return;
  const bool counts = time.sample_time == 1 && time.is_even && time.missing == 0;
  find("time_without_unit",
       fmt::format("\"{}\" has no unit and is taken as s: a row every {:.4g} s, {:.6g} s in all", raw.name,
                   time.sample_time, time.at.back() - time.at.front()),
       counts
           ? "it counts rows: if it is no time in s, give the column a unit and a \"scale\" in the experiment"
           : fmt::format("if it is in ms, write \"{} [ms]\" into the heading, or \"unit\": \"ms\" in the "
                         "experiment's \"columns\"",
                         raw.name));
}

void Looker::measure_grid(LookedTime& time) {
  Problems own;
  const TimeAxis axis = check_time({time.column, "s", time.at, ""}, own);
  time.sample_time = axis.sample_time, time.is_even = axis.on_grid, time.missing = axis.missing;
  time.digit = last_digit(time.at), time.is_rounded = !unrounded(time.at, axis).empty();
  const std::vector<int64_t> sample = sample_numbers(time.at, time.sample_time);
  for (size_t i = 1; i < time.at.size(); ++i)
    if (sample[i] > sample[i - 1] + 1) time.gaps.push_back({time.at[i - 1], sample[i] - sample[i - 1] - 1});
  // The line through all stamps: the first and the last one jitter, too.
  const double rows = double(time.at.size());
  double mean = 0, middle = 0, slope = 0, spread = 0, squares = 0;
  for (size_t i = 0; i < time.at.size(); ++i) mean += time.at[i] / rows, middle += double(sample[i]) / rows;
  for (size_t i = 0; i < time.at.size(); ++i) {
    const double k = double(sample[i]) - middle;
    slope += k * (time.at[i] - mean), spread += k * k;
  }
  slope /= spread;
  for (size_t i = 0; i < time.at.size(); ++i) {
    const double off = time.at[i] - mean - slope * (double(sample[i]) - middle);
    squares += off * off, time.worst_jitter = std::max(time.worst_jitter, std::abs(off));
  }
  time.jitter = std::sqrt(squares / rows);
  // Stamps on a grid are off by the rounding of doubles only.
  const double rounding = 1e-12 * std::max(std::abs(time.at.back()), time.sample_time);
  if (time.worst_jitter <= rounding) time.jitter = time.worst_jitter = 0;
}

void Looker::question_grid(const LookedTime& time) {
  if (!time.gaps.empty())
    find("gaps",
         fmt::format("{} missing at {}, first behind {:.6g} s", counted(size_t(time.missing), "sample"),
                     counted(time.gaps.size(), "place"), time.gaps.front().behind),
         "readers keep the later rows at their times; rows beside a gap do not count");
  if (!time.is_even)
    find("uneven",
         fmt::format("the rows are not even: they lie up to {:.3g} sample times off a grid of {:.6g} s",
                     time.sample_time > 0 ? time.worst_jitter / time.sample_time : 0, time.sample_time),
         "late stamps of even samples, or samples at these times: readers decide by which of the two the "
         "signals "
         "are smooth");
  else if (time.is_rounded || (time.digit > 0.1 * time.sample_time && time.jitter > 0))
    find("rounded_stamps",
         fmt::format("the stamps are rounded to {:g} s, the rows lie {:.6g} s apart", time.digit,
                     time.sample_time),
         time.is_rounded
             ? "the grid is used, not the stamps: compared and driven at its instants"
             : "compared and driven at the stamps: too few rows for a grid, or off it by more than a "
               "digit");
}

LookedColumn Looker::figures(const Column& column) const {
  LookedColumn look;
  look.name = column.name, look.unit = column.unit;
  std::vector<double> value;
  for (double v : column.values)
    if (std::isfinite(v)) value.push_back(v);
  look.not_finite = column.values.size() - value.size(), look.first_hole = hole_text(column);
  if (value.empty()) return look;
  const auto [low, high] = std::ranges::minmax(value);
  look.least = low, look.greatest = high;
  for (double v : value) look.mean += v / double(value.size());
  for (double v : value) look.deviation += (v - look.mean) * (v - look.mean) / double(value.size());
  look.deviation = look.is_constant() ? 0 : std::sqrt(look.deviation);
  look.every = rows_between_changes(value);
  look.resolution = resolution_of(value);
  if (look.is_constant() || look.not_finite > 0 || look.every == 0) return look;
  std::vector<double> at, changing;  // a signal that is held is smooth only from change to change
  size_t first = 0;
  while (first + 1 < value.size() && value[first + 1] == value[first]) ++first;
  for (size_t i = (first + 1) % look.every; i < value.size(); i += look.every)
    at.push_back(look_.time ? look_.time->at[i] : double(i)), changing.push_back(value[i]);
  const double rounding = 1e-12 * std::max(std::abs(low), std::abs(high));
  if (const double noise = noise_of(at, changing); noise > rounding) look.noise = noise;
  look.outliers = outliers(changing);
  for (size_t& row : look.outliers) row = (first + 1) % look.every + row * look.every;
  if (look_.time && look_.time->is_even && look_.time->missing == 0)
    look.repeats_after = double(rows_until_repeat(value, look_.time->sample_time)) * look_.time->sample_time;
  return look;
}

void Looker::look_at_columns() {
  for (const Column& column : look_.recording.columns) {
    if (look_.time && column.name == look_.time->column) continue;
    look_.columns.push_back(figures(column));
    question(look_.columns.back());
  }
}

void Looker::question(const LookedColumn& column) {
  if (column.not_finite > 0)
    find("not_finite",
         fmt::format("\"{}\" has no number in {}{}", column.name, counted(column.not_finite, "row"),
                     column.first_hole.empty() ? "" : ", first " + column.first_hole),
         "readers refuse this column where it is used, unless it is compared and has a number in every n-th "
         "row: "
         "leave out the rows");
  else if (column.is_constant())
    find("constant", fmt::format("\"{}\" is {:g} in all rows", column.name, column.least),
         "a channel that was not connected?");
  if (!column.unit.empty() && !parse_unit(column.unit)) {
    const std::string hint = unit_hint(column.unit);
    find("unit_not_known", fmt::format("the unit \"{}\" of \"{}\" cannot be read", column.unit, column.name),
         "mend the heading: " + (hint.empty() ? "a unit such as N, mm/s, rpm or degC" : hint));
  }
  if (column.every > 1 && look_.time)
    find("slower",
         fmt::format("\"{}\" has a new value in every {}. row only: every {:.4g} s", column.name,
                     column.every, double(column.every) * look_.time->sample_time),
         "it was measured more slowly than the rows were written");
  if (!column.outliers.empty()) {
    const size_t row = column.outliers.front();
    find("outliers",
         fmt::format("{} of \"{}\" {} out of line, first in row {}{}",
                     counted(column.outliers.size(), "value"), column.name,
                     column.outliers.size() == 1 ? "leaps" : "leap", row + 1,
                     look_.time ? fmt::format(" at {:.6g} s", look_.time->at[row]) : ""),
         "single wrong samples");
  }
}

void Looker::compare_columns() {
  std::string without;
  size_t count = 0;
  for (const LookedColumn& column : look_.columns)
    if (column.unit.empty() && column.not_finite < look_.rows) without += (count++ ? ", " : "") + column.name;
  if (count > 0)
    find("no_unit", fmt::format("no unit: {}", without),
         "state it where the column is used (\"unit\" in an experiment), or in the heading: position [m]");
  if (look_.recording.columns.size() > look_.rows && look_.rows > 1)
    find("on_its_side",
         fmt::format("{} and only {}", counted(look_.recording.columns.size(), "column"),
                     counted(look_.rows, "row")),
         "a table on its side? a row is an instant, a column a signal");
  for (size_t i = 0; i < look_.columns.size(); ++i)
    for (size_t j = i + 1; j < look_.columns.size(); ++j) {
      const LookedColumn &a = look_.columns[i], &b = look_.columns[j];
      if (a.is_constant() || a.least != b.least || a.greatest != b.greatest || a.mean != b.mean) continue;
      if (look_.recording.find(a.name)->values == look_.recording.find(b.name)->values)
        find("same_numbers", fmt::format("\"{}\" and \"{}\" have the same numbers", a.name, b.name),
             "one signal recorded twice?");
    }
}

}  // namespace

Look look_at(const std::string& path, const std::string& time) {
  Problems problems;
  Look look;
  look.path = path;
  look.recording = read_recording(path, problems, {.allow_not_finite = true, .allow_holes = true});
  if (problems.has_errors()) throw InputError(std::move(problems));
  look.rows = look.recording.rows();
  if (!time.empty() && !look.recording.find(time)) {
    find_column(look.recording, time, [&](std::string message) -> Problem& {
      return problems.error({}, "", "", std::move(message));
    });
    if (problems.has_errors()) throw InputError(std::move(problems));
  }
  Looker looker(look);
  looker.look_at_time(time);
  looker.look_at_columns();
  looker.compare_columns();
  return look;
}

}  // namespace loopwright
