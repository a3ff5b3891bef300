/// value = column(t) of a recording: held from sample to sample, on straight lines, or smooth between them
///
/// The file is read once, during the check. A sample takes effect a millionth of its interval early, so that
/// times printed with few digits are not late by a tick. A row with the time and the value of the row before
/// is read once.
#include <algorithm>
#include <memory>
#include "engine/block.h"
#include "engine/json/json.h"
#include "engine/record/column_units.h"
#include "engine/record/excerpt.h"
#include "engine/unit/scaled_rate.h"
#include "engine/record/recording_file.h"
#include "engine/record/time_axis.h"
#include "models/signal/between_rows.h"

namespace loopwright::blocks {

enum class Beyond { hold, fault };
constexpr auto names_of(Beyond) { return std::array<std::string_view, 2>{"hold", "fault"}; }

struct RecordedColumn {
  struct Table {
    std::vector<double> begin;  // s; time from which the sample is valid
    RowCurve curve;             // s, SI
  };
  std::string file, column, time_column, unit, experiment;
  BetweenRows interpolation = BetweenRows::hold;
  Beyond beyond = Beyond::hold;
  std::shared_ptr<const Table> table;
  std::optional<Unit> known_unit;  ///< of the file or of `unit`; nothing if neither has one
  struct Out {
    double value;
  };
  struct Mode {
    ptrdiff_t row;
  };  // -1: before the first sample
  static constexpr auto describe() {
    return block(
        "Plays back a column of a recording.",
        parameter(&RecordedColumn::file, "file", "", "CSV or MAT file, relative to the diagram").file(),
        parameter(&RecordedColumn::column, "column", "", "Name of the column"),
        parameter(&RecordedColumn::time_column, "time", "",
                  "Name of the column with the time, in the unit of its heading or in s; \"time\", \"t\" or "
                  "the first when left out")
            .optional(),
        parameter(&RecordedColumn::unit, "unit", "",
                  "Unit of the numbers in the file, where their heading has none")
            .optional(),
        parameter(&RecordedColumn::experiment, "experiment", "",
                  "Experiment file whose \"columns\" and \"excerpt\" apply to the file")
            .file()
            .optional(),
        parameter(&RecordedColumn::interpolation, "interpolation", "", "What holds between samples")
            .optional(),
        parameter(&RecordedColumn::beyond, "beyond", "",
                  "Before the first and after the last sample: hold it, or stop the run")
            .optional(),
        output(&Out::value, "value", "$value", "The column in SI units"));
  }
  void check(const Checker& checker);
  void take_excerpt(const Checker& checker, Recording& recording) const;
  std::vector<UnitClaim> unit_claims() const {
    return known_unit ? std::vector<UnitClaim>{{"$value", *known_unit, "unit"}} : std::vector<UnitClaim>();
  }
  void decide(const Instant& now, Mode& mode) const {
    mode.row =
        std::upper_bound(table->begin.begin(), table->begin.end(), now.time) - table->begin.begin() - 1;
  }
  Fault outputs(const Instant& now, const Mode& mode, Out& out) const {
    const auto& [begin, curve] = *table;
    const std::vector<double>& time = curve.time();
    const size_t row = size_t(std::max(mode.row, ptrdiff_t(0)));
    const bool is_inside = mode.row >= 0 && row + 1 < time.size();
    out.value = interpolation != BetweenRows::hold && is_inside ? curve.at(now.time) : curve.value()[row];
    const bool is_last = row + 1 == time.size() && now.time <= 2 * time[row] - begin[row];
    return fault_if(beyond == Beyond::fault && !is_inside && !(mode.row >= 0 && is_last),
                    "the recording does not reach this time");
  }
  double next_stop(double now) const {
    const std::vector<double>& begin = table->begin;
    if (interpolation == BetweenRows::band_limited)  // smooth between its ends
      return now < begin.front() ? begin.front() : now < begin.back() ? begin.back() : infinity;
    const auto next = std::upper_bound(begin.begin(), begin.end(), now);
    return next == begin.end() ? infinity : *next;
  }
};

/// Samples whose stamps were only rounded are played at their even instants, with which the readers of
/// experiments compare.
void put_on_grid(std::vector<double>& times) {
  Problems ignored;  // uneven times are played as they are, and those that do not rise are reported below
  const TimeAxis axis = check_time({"time", "s", times}, ignored);
  if (std::vector<double> instants = unrounded(times, axis); !instants.empty()) times = std::move(instants);
}

/// The same columns and rows as for the readers of the experiment.
void RecordedColumn::take_excerpt(const Checker& checker, Recording& recording) const {
  const Reader reader{checker.problems(), checker.block()};
  const auto source = read_source(checker.resolve_file("experiment", experiment), checker.place("experiment"),
                                  reader.problems);
  if (!source) return;
  const Value settings = parse_json(source, reader.problems);
  Excerpt::read(settings, reader).apply(recording, time_column, reader);
}

void RecordedColumn::check(const Checker& checker) {
  Problems& problems = checker.problems();
  const size_t before = problems.list().size();
  const auto failed = [&] {
    for (size_t i = before; i < problems.list().size(); ++i)
      if (problems.list()[i].severity == Problem::Severity::error) return true;
    return false;
  };
  Recording recording = read_recording(checker.resolve_file("file", file), problems, {.allow_holes = true});
  if (!experiment.empty() && !failed()) take_excerpt(checker, recording);
  if (failed()) {
    checker.error("file", "the recording cannot be used").found = file;
    return;
  }
  const char* const names_time = time_column.empty() ? "file" : "time";
  const auto error_at = [&](const char* parameter) {
    return [&checker, parameter](std::string message) -> Problem& {
      return checker.error(parameter, std::move(message));
    };
  };
  const Column* values = find_column(recording, column, error_at("column"));
  const auto times = time_in_seconds(recording, time_column, error_at(names_time));
  const auto scale = values ? unit_of(*values, unit, error_at("unit")) : std::nullopt;
  // Its holes are told at their places in the recording; this is the place in the diagram.
  if (!values && recording.find(column)) checker.error("column", "the recording cannot be used").found = file;
  if (!times || !scale) return;
  if (!unit.empty() || !values->unit.empty()) known_unit = kept_in_si(*scale);
  std::vector<double> time, value;
  const std::vector<double> all = in_si(*values, *scale).values;
  for (size_t i = 0; i < all.size(); ++i) {
    const bool repeats = i > 0 && times->values[i] == times->values[i - 1] && all[i] == all[i - 1];
    if (!repeats) time.push_back(times->values[i]), value.push_back(all[i]);
  }
  put_on_grid(time);
  std::vector<double> begin = time;
  for (size_t i = 1; i < time.size(); ++i) {
    const double step = time[i] - time[i - 1];
    begin[i] -= 1e-6 * step;
    if (step > 0) continue;
    auto& p = checker.error(names_time, "time does not rise from sample to sample");
    p.found = reading::number_text(time[i - 1]) + " s, then " + reading::number_text(time[i]) +
              " s at sample " + std::to_string(i + 1) + " of " + times->name;
    return;
  }
  if (time.size() > 1) begin[0] -= 1e-6 * (time[1] - time[0]);
  if (failed()) return;
  table = std::make_shared<const Table>(
      Table{std::move(begin), RowCurve(std::move(time), std::move(value), interpolation)});
}
LOOPWRIGHT_BLOCK(RecordedColumn)

}  // namespace loopwright::blocks
