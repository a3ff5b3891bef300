#include "tools/sweep/sweep_pictures.h"
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include "tools/report/typography.h"
#include "tools/sweep/svg.h"
#include "models/real/whole.h"

namespace loopwright {
namespace {

/// From dark blue over green to yellow: Viridis at nine points, also readable in gray. Source: S. van der
/// Walt, N. Smith, 2015 (CC0).
std::string colour(double share) {
  constexpr std::array<std::array<double, 3>, 9> places{{{68, 1, 84},
                                                         {71, 44, 122},
                                                         {59, 81, 139},
                                                         {44, 113, 142},
                                                         {33, 144, 141},
                                                         {39, 173, 129},
                                                         {92, 200, 99},
                                                         {170, 220, 50},
                                                         {253, 231, 37}}};
  const double at = std::clamp(share, 0.0, 1.0) * 8;
  const size_t i = whole_index(at, 8);
  const double t = at - double(i);
  const auto mix = [&](size_t c) {
    return whole_between(places[i][c] + t * (places[i + 1][c] - places[i][c]) + 0.5, 0, 255);
  };
  return fmt::format("rgb({},{},{})", mix(0), mix(1), mix(2));
}

/// Three digits, without an exponent up to thousands.
std::string short_number(double value) {
  const double size = std::fabs(value);
  return size >= 1000 && size < 1e5 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}
std::string value_text(const Axis& axis, double value) {
  return axis.kind == Axis::Kind::variants ? axis.variants[whole_index(value, axis.variants.size())]
                                           : fmt::format("{:.3g}", value);
}
std::string bin_text(const Axis& axis, const Bin& bin) {
  return bin.from == bin.to ? value_text(axis, bin.from) : fmt::format("{:.3g} … {:.3g}", bin.from, bin.to);
}
std::string label(const Axis& axis) { return report::escape_html(report::with_unit(axis.name, axis.unit)); }

using svg::words;

}  // namespace

report::Picture heat_map(const SweepPlan& plan, const Recording& table, size_t metric,
                         const std::vector<AxisEffect>& effects) {
  const auto& axes = plan.sweep().axes;
  std::vector<size_t> order(axes.size());
  std::iota(order.begin(), order.end(), 0);
  const auto weight = [&](size_t a) { return effects[a].total.value_or(effects[a].first_order); };
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return weight(a) > weight(b); });
  const size_t across = order[0], up = order[1];
  const auto& values = table.columns[1 + axes.size() + metric].values;
  int columns = 0, rows = 0;
  const auto x = bins_of(axes[across], table.columns[1 + across].values, 12, columns);
  const auto y = bins_of(axes[up], table.columns[1 + up].values, 12, rows);
  std::vector<double> sum(size_t(columns * rows)), count(sum.size());
  for (size_t row = 0; row < values.size(); ++row)
    if (std::isfinite(values[row]))
      sum[size_t(y[row] * columns + x[row])] += values[row], count[size_t(y[row] * columns + x[row])] += 1;
  double low = INFINITY, high = -INFINITY;
  for (size_t i = 0; i < sum.size(); ++i)
    if (count[i] > 0) sum[i] /= count[i], low = std::min(low, sum[i]), high = std::max(high, sum[i]);

  constexpr double left = 150, top = 10, cell_height = 26;
  const double cell = 560.0 / std::max(1, columns), bottom = top + cell_height * rows;
  std::string inside;
  for (int r = 0; r < rows; ++r) {
    const double at = bottom - cell_height * (r + 1);
    inside +=
        words(left - 6, at + 17, "end", report::escape_html(bin_text(axes[up], effects[up].bins[size_t(r)])));
    for (int c = 0; c < columns; ++c) {
      const size_t i = size_t(r * columns + c);
      if (count[i] == 0) continue;
      const double share = high > low ? (sum[i] - low) / (high - low) : 0.5;
      inside += fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="{}"/>)",
                            left + cell * c, at, cell, cell_height, colour(share));
      if (cell > 38)
        inside += words(left + cell * (c + 0.5), at + 17, "middle", short_number(sum[i]),
                        fmt::format(R"(fill="{}")", share > 0.6 ? "black" : "white"));
    }
  }
  for (int c = 0; c < columns; ++c)
    inside += words(left + cell * (c + 0.5), bottom + 16, columns > 6 ? "end" : "middle",
                    report::escape_html(bin_text(axes[across], effects[across].bins[size_t(c)])),
                    columns > 6 ? fmt::format(R"svg(transform="rotate(-35 {:.1f} {:.1f})")svg",
                                              left + cell * (c + 0.5), bottom + 16)
                                : "");
  const double below = bottom + (columns > 6 ? 78 : 36);
  inside += words(left + 280, below, "middle", label(axes[across]));
  inside += words(14, top + cell_height * rows / 2, "middle", label(axes[up]),
                  fmt::format(R"svg(transform="rotate(-90 14 {:.1f})")svg", top + cell_height * rows / 2));
  report::Picture picture;
  picture.svg = svg::picture(left + 570, below + 12, inside);
  const std::string name =
      report::with_unit(plan.sweep().metrics[metric].name, plan.world(0).observed.units[metric]);
  picture.caption =
      fmt::format("Mean of {} over the two axes it hangs on most, from {:.4g} (dark) to {:.4g} (light).",
                  name, low, high);
  picture.text = picture.caption;
  return picture;
}

report::Picture parallel_coordinates(const SweepPlan& plan, const Recording& table, size_t metric) {
  constexpr size_t most_lines = 300;
  constexpr double left = 70, top = 24, height = 260;
  const auto& axes = plan.sweep().axes;
  const auto& values = table.columns[1 + axes.size() + metric].values;
  std::vector<size_t> rows;
  for (size_t row = 0; row < values.size(); ++row)
    if (std::isfinite(values[row])) rows.push_back(row);
  std::stable_sort(rows.begin(), rows.end(), [&](size_t a, size_t b) { return values[a] < values[b]; });
  const double stride = std::max(1.0, double(rows.size()) / double(most_lines));
  std::vector<size_t> columns;
  for (size_t a = 0; a <= axes.size(); ++a)
    columns.push_back(a < axes.size() ? 1 + a : 1 + axes.size() + metric);
  const double gap = 720.0 / double(std::max<size_t>(1, columns.size() - 1));
  std::vector<double> low, high;
  for (const size_t c : columns) {
    low.push_back(INFINITY), high.push_back(-INFINITY);
    for (const size_t row : rows)
      low.back() = std::min(low.back(), table.columns[c].values[row]),
      high.back() = std::max(high.back(), table.columns[c].values[row]);
  }
  std::string inside;
  for (double i = 0; i < double(rows.size()); i += stride) {
    const size_t row = rows[size_t(i)];
    std::string points;
    for (size_t k = 0; k < columns.size(); ++k) {
      const double share =
          high[k] > low[k] ? (table.columns[columns[k]].values[row] - low[k]) / (high[k] - low[k]) : 0.5;
      points += fmt::format("{:.1f},{:.1f} ", left + gap * double(k), top + height * (1 - share));
    }
    inside += fmt::format(R"(<polyline points="{}" fill="none" stroke="{}" stroke-opacity="0.6"/>)", points,
                          colour(i / std::max(1.0, double(rows.size()) - 1)));
  }
  for (size_t k = 0; k < columns.size() && !rows.empty(); ++k) {
    const double at = left + gap * double(k);
    const bool is_axis = k < axes.size();
    const auto number = [&](double v) {
      return report::escape_html(is_axis ? value_text(axes[k], v) : short_number(v));
    };
    inside += fmt::format(R"(<line x1="{0:.1f}" x2="{0:.1f}" y1="{1}" y2="{2}" stroke="currentColor"/>)", at,
                          top, top + height);
    inside += words(at, top - 8, "middle", number(high[k])) +
              words(at, top + height + 16, "middle", number(low[k]));
    inside += words(at, top + height + (k % 2 ? 50 : 34), "middle",
                    is_axis ? label(axes[k]) : report::escape_html(plan.sweep().metrics[metric].name));
  }
  report::Picture picture;
  picture.svg = svg::picture(left + 790, top + height + 60, inside);
  picture.caption =
      fmt::format("A line for each run{}, dark where {} is least and light where it is greatest.",
                  stride > 1 ? fmt::format(" ({} of {}, evenly by rank)", most_lines, rows.size()) : "",
                  plan.sweep().metrics[metric].name);
  picture.text = picture.caption;
  return picture;
}

report::Picture worst_in_distribution(const SweepPlan& plan, const Recording& table, size_t metric,
                                      const std::vector<size_t>& worst, const TracePages& traces) {
  constexpr size_t bars = 48;
  constexpr double left = 20, top = 12, width = 600, height = 130, line_height = 18;
  const auto& values = table.columns[1 + plan.sweep().axes.size() + metric].values;
  const std::string& unit = plan.world(0).observed.units[metric];
  double low = INFINITY, high = -INFINITY;
  for (const double value : values)
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  const double span = high > low ? high - low : 1;
  std::array<double, bars> count{};
  for (const double value : values)
    if (std::isfinite(value)) count[whole_index((value - low) / span * double(bars), bars)] += 1;
  const double most = std::max(1.0, *std::max_element(count.begin(), count.end()));
  std::string inside;
  for (size_t i = 0; i < bars; ++i) {
    const double tall = height * count[i] / most;
    if (tall > 0)
      inside += fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="{}"/>)",
                            left + width * double(i) / double(bars), top + height - tall,
                            width / double(bars) - 1, std::max(1.0, tall), colour(0.35));
  }
  inside += svg::line(left, top + height, left + width, top + height, R"(stroke="currentColor")");
  inside += words(left, top + height + 16, "start", short_number(low)) +
            words(left + width, top + height + 16, "end", short_number(high)) +
            words(left + width / 2, top + height + 16, "middle",
                  report::escape_html(report::with_unit(plan.sweep().metrics[metric].name, unit)));
  for (size_t i = 0; i < worst.size(); ++i) {
    const int64_t run = int64_t(table.columns[0].values[worst[i]]);
    const double at = left + width * (values[worst[i]] - low) / span, y = top + 12 + line_height * double(i);
    inside += svg::line(at, top + height, left + width + 24, y - 4,
                        R"svg(style="stroke:var(--series-1);stroke-width:0.8")svg");
    const std::string text =
        words(left + width + 30, y, "start", fmt::format("run {}: {}", run, short_number(values[worst[i]])));
    const auto page = traces.find(run);
    inside += page == traces.end() ? text
                                   : fmt::format(R"svg(<a href="{}" style="fill:var(--link)">{}</a>)svg",
                                                 report::escape_html(page->second), text);
  }
  report::Picture picture;
  picture.svg = svg::picture(left + 790, top + height + 24, inside);
  picture.caption =
      fmt::format("How often {} takes which value, and its worst runs{}.", plan.sweep().metrics[metric].name,
                  traces.empty() ? "" : "; those that were kept lead to their traces");
  picture.text = picture.caption;
  return picture;
}

}  // namespace loopwright
