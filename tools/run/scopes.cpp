#include "tools/run/scopes.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include "models/signal/amplitude_spectrum.h"
#include "tools/report/typography.h"

namespace loopwright {
namespace {

using report::Series;

std::string unit_text(const Column& column) { return column.unit == "1" ? "" : column.unit; }

double peak_of(const Column& column) {
  double peak = 0;
  for (const double v : column.values)
    if (std::isfinite(v)) peak = std::max(peak, std::abs(v));
  return peak;
}

/// The columns of the first recording that share a scope.
struct Scope {
  std::string unit;
  double peak;
  std::vector<std::string> signals;
  bool takes(const Column& column, double size, size_t most_signals) const {
    constexpr double like = 30;
    return !unit.empty() && unit == column.unit && signals.size() < most_signals && size <= like * peak &&
           peak <= like * size;
  }
};

std::vector<Scope> grouped(const std::vector<NamedRecording>& runs) {
  const size_t most_signals = runs.size() == 1 ? 6 : 2;  // a scope has curves of all runs
  std::vector<Scope> scopes;
  const Recording& first = *runs.front().recording;
  for (size_t c = 1; c < first.columns.size(); ++c) {
    const Column& column = first.columns[c];
    if (SignalRange(column.values).not_finite == column.values.size()) continue;  // remarks have no curve
    const double peak = peak_of(column);
    auto scope =
        std::ranges::find_if(scopes, [&](const Scope& s) { return s.takes(column, peak, most_signals); });
    if (scope == scopes.end()) scope = scopes.insert(scopes.end(), {column.unit, peak, {}});
    scope->signals.push_back(column.name);
  }
  return scopes;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string curve_name(const std::string& signal, const NamedRecording& run, size_t runs) {
  return runs == 1 ? signal : signal + " · " + run.name;
}

/// The part of the name that all signals of a scope share, or a word for them.
std::string axis_label(const std::vector<std::string>& signals) {
  if (signals.size() == 1) return signals.front();
  const auto last = [](const std::string& name) { return name.substr(name.rfind('.') + 1); };
  const std::string word = last(signals.front());
  const bool same = std::ranges::all_of(signals, [&](const std::string& s) { return last(s) == word; });
  return same ? word : "";
}

/// The values of a column at other times, linear between rows; NaN outside.
std::vector<double> at_times(const Recording& recording, const Column& column,
                             const std::vector<double>& times) {
  const std::vector<double>& own = recording.columns.front().values;
  std::vector<double> values;
  size_t row = 0;
  for (const double t : times) {
    while (row + 1 < own.size() && own[row + 1] <= t) ++row;
    if (own.empty() || t < own.front() || t > own.back())
      values.push_back(NAN);
    else if (own[row] == t || row + 1 == own.size())
      values.push_back(column.values[row]);
    else
      values.push_back(column.values[row] + (column.values[row + 1] - column.values[row]) * (t - own[row]) /
                                                (own[row + 1] - own[row]));
  }
  return values;
}

/// Numbers of one row of a table share the prefix of their greatest: "38.9 µm" is never "3.89e-05".
struct RowUnit {
  std::string unit;
  double factor = 1;
  RowUnit(double peak, const std::string& si) {
    const report::Quantity q = report::engineering(peak, si, 6);
    unit = q.unit;
    const double shown = std::strtod(q.value.c_str(), nullptr);
    if (peak > 0 && shown > 0) factor = std::pow(10.0, std::round(std::log10(shown / peak)));
  }
  std::string operator()(double value) const { return fmt::format("{:.5g}", value * factor + 0.0); }
};

/// In rows that hold a number; "–" where a signal has none.
std::vector<std::string> figures_of(const Column& column, const SignalRange& range) {
  const RowUnit shown(peak_of(column), unit_text(column));
  std::vector<std::string> cells{shown.unit};
  for (const double figure : {range.least, range.greatest, range.mean, range.rms, range.last})
    cells.push_back(std::isnan(figure) ? "–" : shown(figure));
  return cells;
}

bool has_gaps(const std::vector<NamedRecording>& runs) {
  return std::ranges::any_of(runs, [](const NamedRecording& run) {
    return std::ranges::any_of(run.recording->columns, [](const Column& column) {
      return !std::ranges::all_of(column.values, [](double v) { return std::isfinite(v); });
    });
  });
}

double even_step(const std::vector<double>& time) {
  if (time.size() < 8) return 0;
  const double step = (time.back() - time.front()) / double(time.size() - 1);
  for (size_t i = 0; i < time.size(); ++i)
    if (!(std::abs(time[i] - (time.front() + step * double(i))) < 1e-3 * step)) return 0;
  return step;
}

}  // namespace

SignalRange::SignalRange(const std::vector<double>& values) {
  double sum = 0, squares = 0;
  least = INFINITY, greatest = -INFINITY;
  for (const double v : values) {
    if (!std::isfinite(v)) {
      ++not_finite;
      continue;
    }
    least = std::min(least, v), greatest = std::max(greatest, v);
    sum += v, squares += v * v;
  }
  const double count = double(values.size() - not_finite);
  mean = sum / count, rms = std::sqrt(squares / count);
  last = values.empty() ? NAN : values.back();
  if (count == 0) least = greatest = mean = rms = NAN;
}

std::vector<report::Plot> scopes(const std::vector<NamedRecording>& runs,
                                 const std::function<bool(const std::string&)>& is_held) {
  std::vector<report::Plot> plots;
  for (const Scope& scope : grouped(runs)) {
    report::Plot plot{"",
                      {"Time", "s", false},
                      {axis_label(scope.signals), scope.unit == "1" ? "" : scope.unit, false},
                      {},
                      "time",
                      ""};
    for (const std::string& signal : scope.signals)
      for (const NamedRecording& run : runs)
        if (const Column* column = run.recording->find(signal))
          plot.series.push_back({curve_name(signal, run, runs.size()), run.recording->columns[0].values,
                                 column->values,
                                 is_held(signal) ? Series::Shape::steps : Series::Shape::line});
    plot.title = joined(scope.signals) + " over time";
    plots.push_back(std::move(plot));
  }
  return plots;
}

std::vector<report::Plot> spectra(const std::vector<NamedRecording>& runs) {
  std::vector<report::Plot> plots;
  constexpr size_t most_plots = 8;
  for (const Scope& scope : grouped(runs)) {
    report::Plot plot{"",
                      {"Frequency", "Hz", true},
                      {"Amplitude", scope.unit == "1" ? "" : scope.unit, true},
                      {},
                      "spectrum",
                      ""};
    for (const std::string& signal : scope.signals)
      for (const NamedRecording& run : runs) {
        const Column* column = run.recording->find(signal);
        if (!column || !std::ranges::all_of(column->values, [](double v) { return std::isfinite(v); }))
          continue;
        AmplitudeSpectrum s = amplitude_spectrum(column->values, even_step(run.recording->columns[0].values));
        // Of a constant only the rounding of its mean would be seen.
        if (!s.frequency.empty() && std::ranges::max(column->values) > std::ranges::min(column->values))
          plot.series.push_back(
              {curve_name(signal, run, runs.size()), std::move(s.frequency), std::move(s.amplitude)});
      }
    plot.title = "Amplitude spectrum of " + joined(scope.signals);
    plot.caption = "The whole run without its mean, under a Hann window";
    if (!plot.series.empty() && plots.size() < most_plots) plots.push_back(std::move(plot));
  }
  return plots;
}

report::Table signal_table(const std::vector<NamedRecording>& runs) {
  report::Table table{{"Signal"}, {}, "Range, mean and last value of the signals"};
  if (runs.size() > 1) table.head.push_back("Run");
  for (const char* word : {"Unit", "Least", "Greatest", "Mean", "RMS", "Last"}) table.head.push_back(word);
  const bool counts_gaps = has_gaps(runs);
  if (counts_gaps) table.head.push_back("Rows without a number");
  for (const Column& first : runs.front().recording->columns)
    for (const NamedRecording& run : runs) {
      const Column* column = run.recording->find(first.name);
      if (&first == &runs.front().recording->columns.front() || !column || column->values.empty()) continue;
      const SignalRange range(column->values);
      std::vector<std::string> row{column->name};
      if (runs.size() > 1) row.push_back(run.name);
      for (std::string& cell : figures_of(*column, range)) row.push_back(std::move(cell));
      if (counts_gaps) row.push_back(fmt::format("{}", range.not_finite));
      table.rows.push_back(std::move(row));
    }
  return table;
}

report::Section differences(const std::vector<NamedRecording>& runs) {
  report::Section section{"Differences", {}};
  report::Table table{
      {"Signal", "Run", "Unit", "RMS", "Greatest", "At (s)"},
      {},
      fmt::format("What the runs have more than {}, over the common time", runs.front().name)};
  std::vector<report::Plot> plots;
  std::string left_out;
  const Recording& first = *runs.front().recording;
  const std::vector<double>& time = first.columns.front().values;
  for (size_t c = 1; c < first.columns.size(); ++c) {
    const Column& column = first.columns[c];
    report::Plot plot{"Difference of " + column.name + " to " + runs.front().name,
                      {"Time", "s", false},
                      {column.name, unit_text(column), false},
                      {},
                      "time",
                      ""};
    for (size_t r = 1; r < runs.size(); ++r) {
      const Column* other = runs[r].recording->find(column.name);
      if (!other || unit_text(*other) != unit_text(column)) {
        left_out +=
            fmt::format("{}{} {}", left_out.empty() ? "" : "; ", runs[r].name,
                        other ? fmt::format("has {} in {}, not {}", column.name, other->unit, column.unit)
                              : "has no " + column.name);
        continue;
      }
      std::vector<double> difference = at_times(*runs[r].recording, *other, time);
      double squares = 0, most = 0, at = 0;
      size_t count = 0;
      for (size_t i = 0; i < difference.size(); ++i) {
        difference[i] -= column.values[i];
        if (!std::isfinite(difference[i])) continue;
        squares += difference[i] * difference[i], ++count;
        if (std::abs(difference[i]) > most) most = std::abs(difference[i]), at = time[i];
      }
      if (count == 0) continue;
      const RowUnit shown(most, unit_text(column));
      table.rows.push_back({column.name, runs[r].name, shown.unit, shown(std::sqrt(squares / double(count))),
                            shown(most), fmt::format("{:.6g}", at)});
      if (most > 0) plot.series.push_back({runs[r].name, time, std::move(difference)});
    }
    if (!plot.series.empty()) plots.push_back(std::move(plot));
  }
  section.items.push_back(std::move(table));
  if (!left_out.empty())
    section.items.push_back(
        report::Notice{report::Notice::Severity::warning, "Not compared: " + left_out + "."});
  for (report::Plot& plot : plots) section.items.push_back(std::move(plot));
  return section;
}

}  // namespace loopwright
