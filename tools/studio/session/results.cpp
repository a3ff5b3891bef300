#include "tools/studio/session/results.h"
#include <algorithm>
#include <cmath>
#include "tools/report/thin.h"

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

Json signals_json(const Recording& recording, const Window& window, const std::set<std::string>& held) {
  Json list = Json::array();
  if (recording.columns.empty()) return list;
  const std::vector<double>& time = recording.columns.front().values;
  const auto [first, last] = rows_of(time, window.from, window.to);
  for (size_t c = 1; c < recording.columns.size(); ++c) {
    const Column& column = recording.columns[c];
    if (!is_named(window, column.name)) continue;
    const std::span<const double> values = std::span(column.values).subspan(first, last - first);
    double square = 0, low = INFINITY, high = -INFINITY;
    for (double v : values) square += v * v, low = std::min(low, v), high = std::max(high, v);
    Json curve = thinned_curve(std::span(time).subspan(first, last - first), values, window.points);
    // A thinned curve has its extremes only: drawn as steps, each would look held over many samples.
    const bool is_whole = curve["x"].size() == values.size();
    list.push_back({{"name", column.name},
                    {"unit", column.unit == "1" ? "" : column.unit},
                    {"steps", is_whole && held.contains(column.name)},
                    {"rms", values.empty() ? 0 : std::sqrt(square / double(values.size()))},
                    {"min", low},
                    {"max", high},
                    {"last", values.empty() ? NAN : values.back()},
                    {"x", std::move(curve["x"])},
                    {"y", std::move(curve["y"])}});
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
