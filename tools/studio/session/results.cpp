#include "tools/studio/session/results.h"
#include <algorithm>
#include <cmath>

namespace loopwright::studio {
namespace {

/// Rows of a window, and one more at each side so that lines reach its edges.
std::pair<size_t, size_t> rows_of(std::span<const double> time, double from, double to) {
  size_t first = size_t(std::ranges::lower_bound(time, from) - time.begin());
  size_t last = size_t(std::ranges::upper_bound(time, to) - time.begin());
  if (first > 0) --first;
  if (last < time.size()) ++last;
  return {first, std::max(first, last)};
}

bool is_named(const Window& window, const std::string& name) {
  return window.names.empty() || std::ranges::find(window.names, name) != window.names.end();
}

}  // namespace

Json thinned_curve(std::span<const double> x, std::span<const double> y, size_t points) {
  const std::vector<size_t> kept = report::thin(y, 2 * points);
  std::vector<double> at, values;
  at.reserve(kept.size()), values.reserve(kept.size());
  for (size_t i : kept) at.push_back(x[i]), values.push_back(y[i]);
  return {{"x", std::move(at)}, {"y", std::move(values)}};
}

Signals::Signals(Recording recorded) : recording(std::move(recorded)) {
  for (size_t c = 1; c < recording.columns.size(); ++c) summaries.emplace_back(recording.columns[c].values);
}

Json signals_json(const Signals& signals, const Window& window, const std::set<std::string>& held) {
  Json list = Json::array();
  const std::vector<Column>& columns = signals.recording.columns;
  if (columns.empty()) return list;
  const std::vector<double>& time = columns.front().values;
  const auto [first, last] = rows_of(time, window.from, window.to);
  for (size_t c = 1; c < columns.size(); ++c) {
    const Column& column = columns[c];
    if (!is_named(window, column.name)) continue;
    const std::vector<double>& values = column.values;
    const report::CurveSummary& summary = signals.summaries[c - 1];
    const std::vector<size_t> kept = summary.thin(values, first, last, 2 * window.points);
    std::vector<double> x, y;
    x.reserve(kept.size()), y.reserve(kept.size());
    for (size_t i : kept) x.push_back(time[i]), y.push_back(values[i]);
    const auto range = summary.range(values, first, last);
    const size_t rows = last - first;
    // A thinned curve has its extremes only: drawn as steps, each would look held over many samples.
    const bool is_whole = kept.size() == rows;
    list.push_back({{"name", column.name},
                    {"unit", column.unit == "1" ? "" : column.unit},
                    {"steps", is_whole && held.contains(column.name)},
                    {"rms", rows ? std::sqrt(range.sum_of_squares / double(rows)) : 0},
                    {"min", range.lowest},
                    {"max", range.highest},
                    {"last", rows ? values[last - 1] : NAN},
                    {"x", std::move(x)},
                    {"y", std::move(y)}});
  }
  return list;
}

Recording cut(const Recording& recording, const Window& window) {
  Recording part;
  part.facts = recording.facts;
  if (recording.columns.empty()) return part;
  const auto [first, last] = rows_of(recording.columns.front().values, window.from, window.to);
  for (size_t c = 0; c < recording.columns.size(); ++c) {
    const Column& column = recording.columns[c];
    if (c > 0 && !is_named(window, column.name)) continue;
    part.columns.push_back(
        {column.name,
         column.unit,
         {column.values.begin() + ptrdiff_t(first), column.values.begin() + ptrdiff_t(last)},
         ""});
  }
  return part;
}

}  // namespace loopwright::studio
