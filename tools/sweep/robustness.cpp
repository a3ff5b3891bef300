#include "tools/sweep/robustness.h"
#include <algorithm>
#include <array>
#include <cmath>
#include "tools/report/typography.h"
#include "tools/sweep/sensitivity.h"
#include "tools/sweep/svg.h"
#include "models/statistics/quantile.h"

namespace loopwright {
namespace {

const std::vector<double>& metric_values(const SweepPlan& plan, const Recording& table, size_t metric) {
  return table.columns[1 + plan.sweep().axes.size() + metric].values;
}
double finite_or_infinite(double value) { return std::isfinite(value) ? value : INFINITY; }

Profile profile(const SweepPlan& plan, const Recording& table, size_t metric, size_t by, size_t axis) {
  const auto& variant = table.columns[1 + by].values;
  const auto& x = table.columns[1 + axis].values;
  const auto& y = metric_values(plan, table, metric);
  int count = 0;
  const std::vector<int> bins = bins_of(plan.sweep().axes[axis], x, most_bins, count);
  const size_t variants = plan.sweep().axes[by].variants.size();
  std::vector<std::vector<double>> values(variants * size_t(count));
  Profile result{axis, {}};
  result.spread.assign(variants, std::vector<Spread>(size_t(count), Spread{INFINITY, -INFINITY, 0, 0, 0}));
  for (size_t row = 0; row < y.size(); ++row) {
    const size_t v = size_t(variant[row]), b = size_t(bins[row]);
    values[v * size_t(count) + b].push_back(finite_or_infinite(y[row]));
    for (auto& of_variant : result.spread) {
      of_variant[b].from = std::min(of_variant[b].from, x[row]);
      of_variant[b].to = std::max(of_variant[b].to, x[row]);
    }
  }
  for (size_t v = 0; v < variants; ++v)
    for (size_t b = 0; b < size_t(count); ++b) {
      auto& here = values[v * size_t(count) + b];
      Spread& spread = result.spread[v][b];
      spread.low = quantile(here, 0.25), spread.median = quantile(here, 0.5),
      spread.high = quantile(here, 0.75);
    }
  return result;
}

/// One direction of a panel: maps values to coordinates, and gives the positions of its ticks.
struct Scale {
  double low = 0, high = 1, start = 0, end = 1;  // start and end: coordinates in the picture
  bool is_logarithmic = false;

  double share(double value) const {
    return is_logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  }
  /// Values outside are drawn at the border.
  double at(double value) const {
    return start + (end - start) * (value >= high ? 1 : value <= low ? 0 : share(value));
  }
  /// 1, 2 and 5 times powers of ten: all of them on a logarithmic scale, otherwise multiples of one.
  std::vector<double> ticks(int about) const {
    std::vector<double> found;
    constexpr std::array<double, 3> steps{1, 2, 5};
    if (is_logarithmic) {
      for (double decade = std::pow(10, std::floor(std::log10(low))); decade <= high; decade *= 10)
        for (const double step : steps)
          if (step * decade >= low * 0.999 && step * decade <= high * 1.001) found.push_back(step * decade);
      return found;
    }
    const double wanted = (high - low) / about, decade = std::pow(10, std::floor(std::log10(wanted)));
    double step = 10 * decade;
    for (const double s : {5.0, 2.0, 1.0})
      if (s * decade >= wanted) step = s * decade;
    for (double tick = std::ceil(low / step - 1e-9) * step; tick <= high + 1e-9 * step; tick += step)
      found.push_back(std::fabs(tick) < 1e-9 * step ? 0 : tick);
    return found;
  }
};

/// From the smallest to the largest finite value of all bands; logarithmic if the ratio exceeds eight.
Scale scale_of_metric(const std::vector<Profile>& profiles) {
  double low = INFINITY, high = -INFINITY;
  for (const Profile& p : profiles)
    for (const auto& of_variant : p.spread)
      for (const Spread& s : of_variant)
        for (const double value : {s.low, s.median, s.high})
          if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  if (!(low <= high)) return {};
  Scale scale;
  scale.is_logarithmic = low > 0 && high > 8 * low;
  const double margin = high > low ? 0.05 * (high - low) : std::max(std::fabs(high), 1.0);
  scale.low = scale.is_logarithmic ? low / 1.15 : low >= 0 ? 0 : low - margin;
  scale.high = scale.is_logarithmic ? high * 1.15 : high + margin;
  return scale;
}

double middle(const Spread& s) { return 0.5 * (s.from + s.to); }
std::string colour(size_t variant) { return fmt::format("var(--series-{})", variant % 8); }

/// The middle half of the runs.
std::string band(const std::vector<Spread>& spread, const Scale& x, const Scale& y, size_t variant) {
  std::string upper, lower;
  for (const Spread& s : spread) {
    if (std::isnan(s.median)) continue;
    const double at = x.at(middle(s));
    upper += fmt::format("{:.1f},{:.1f} ", at, y.at(s.high));
    lower.insert(0, fmt::format("{:.1f},{:.1f} ", at, y.at(s.low)));
  }
  return fmt::format(R"(<polygon points="{}{}" style="fill:{};fill-opacity:0.14"/>)", upper, lower,
                     colour(variant));
}

std::string median_curve(const std::vector<Spread>& spread, const Scale& x, const Scale& y, size_t variant) {
  std::string points, marks;
  for (const Spread& s : spread) {
    if (std::isnan(s.median)) continue;
    const double at = x.at(middle(s)), up = y.at(s.median);
    points += fmt::format("{:.1f},{:.1f} ", at, up);
    marks +=
        fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="2.6" style="fill:{}"/>)", at, up, colour(variant));
  }
  return fmt::format(R"(<polyline points="{}" style="fill:none;stroke:{};stroke-width:2.2"/>)", points,
                     colour(variant)) +
         marks;
}

struct Panel {
  double left, top, width, height;
};

std::string frame(const Panel& p, const Scale& x, const Scale& y, bool has_numbers) {
  const std::string grid = R"svg(style="stroke:var(--grid)")svg";
  std::string drawn;
  for (const double tick : y.ticks(5)) {
    drawn += svg::line(p.left, y.at(tick), p.left + p.width, y.at(tick), grid);
    if (has_numbers) drawn += svg::words(p.left - 6, y.at(tick) + 4, "end", fmt::format("{:g}", tick));
  }
  for (const double tick : x.ticks(4)) {
    drawn += svg::line(x.at(tick), p.top, x.at(tick), p.top + p.height, grid);
    drawn += svg::words(x.at(tick), p.top + p.height + 16, "middle", fmt::format("{:.4g}", tick));
  }
  return drawn + svg::line(p.left, p.top, p.left, p.top + p.height, R"(stroke="currentColor")") +
         svg::line(p.left, p.top + p.height, p.left + p.width, p.top + p.height, R"(stroke="currentColor")");
}

std::string panel(const SweepPlan& plan, const Profile& profile, const Panel& p, Scale y,
                  const Metric& metric, bool has_numbers) {
  const Axis& axis = plan.sweep().axes[profile.axis];
  const auto& bins = profile.spread[0];
  Scale x;
  x.low = middle(bins.front()), x.high = middle(bins.back());
  if (x.low == x.high) x.high = x.low + 1;
  x.is_logarithmic = axis.kind == Axis::Kind::logarithmic && x.low > 0;
  x.start = p.left + 8, x.end = p.left + p.width - 8;
  y.start = p.top + p.height, y.end = p.top;
  std::string drawn = frame(p, x, y, has_numbers);
  for (const double limit : {metric.least, metric.most})
    if (limit > y.low && limit < y.high)
      drawn += svg::line(p.left, y.at(limit), p.left + p.width, y.at(limit),
                         R"svg(style="stroke:var(--error);stroke-dasharray:5 4")svg");
  for (size_t v = 0; v < profile.spread.size(); ++v) drawn += band(profile.spread[v], x, y, v);
  for (size_t v = 0; v < profile.spread.size(); ++v) drawn += median_curve(profile.spread[v], x, y, v);
  return drawn + svg::words(p.left + p.width / 2, p.top + p.height + 34, "middle",
                            report::escape_html(report::with_unit(axis.name, axis.unit)));
}

}  // namespace

std::vector<Profile> profiles_of(const SweepPlan& plan, const Recording& table, size_t metric, size_t by) {
  std::vector<Profile> profiles;
  for (size_t axis = 0; axis < plan.sweep().axes.size(); ++axis)
    if (plan.sweep().axes[axis].kind != Axis::Kind::variants && table.rows() > 0)
      profiles.push_back(profile(plan, table, metric, by, axis));
  return profiles;
}

report::Picture robustness_picture(const SweepPlan& plan, const Recording& table, size_t metric, size_t by) {
  constexpr size_t in_row = 3;
  constexpr double left = 70, top = 34, width = 268, height = 250, gap = 22, below = 52;
  const Metric& m = plan.sweep().metrics[metric];
  const Axis& variants = plan.sweep().axes[by];
  const auto profiles = profiles_of(plan, table, metric, by);
  const Scale y = scale_of_metric(profiles);
  std::string inside;
  for (size_t i = 0; i < profiles.size(); ++i) {
    const Panel place{left + double(i % in_row) * (width + gap), top + double(i / in_row) * (height + below),
                      width, height};
    inside += panel(plan, profiles[i], place, y, m, i % in_row == 0);
    if (i % in_row == 0)
      inside +=
          svg::words(14, place.top + height / 2, "middle",
                     report::escape_html(report::with_unit(m.name, plan.world(0).observed.units[metric])),
                     fmt::format(R"svg(transform="rotate(-90 14 {:.1f})")svg", place.top + height / 2));
  }
  double at = left;
  for (size_t v = 0; v < variants.variants.size(); ++v) {
    inside += fmt::format(R"(<rect x="{:.1f}" y="8" width="18" height="4" style="fill:{}"/>)", at, colour(v));
    inside += svg::words(at + 24, 14, "start", report::escape_html(variants.variants[v]));
    at += 44 + 7.2 * double(report::text_width(variants.variants[v]));
  }
  const size_t rows = (profiles.size() + in_row - 1) / in_row, columns = std::min(in_row, profiles.size());
  report::Picture picture;
  picture.svg =
      svg::picture(left + double(columns) * (width + gap), top + double(rows) * (height + below), inside);
  picture.caption = fmt::format(
      "{} along each axis: the median and the middle half of the runs, whatever the other axes are there. "
      "Low is good; flat and narrow is robust.{}",
      m.name, y.is_logarithmic ? " The scale is logarithmic." : "");
  picture.text = picture.caption;
  return picture;
}

report::Table robustness_table(const SweepPlan& plan, const Recording& table, size_t metric, size_t by) {
  const auto& axes = plan.sweep().axes;
  const Metric& m = plan.sweep().metrics[metric];
  const auto profiles = profiles_of(plan, table, metric, by);
  report::Table shown;
  shown.head = {axes[by].name, "Median", "95 %", "Worst"};
  for (const Profile& p : profiles) shown.head.push_back("× over " + axes[p.axis].name);
  const auto& variant = table.columns[1 + by].values;
  const auto& y = metric_values(plan, table, metric);
  for (size_t v = 0; v < axes[by].variants.size(); ++v) {
    std::vector<double> values;
    for (size_t row = 0; row < y.size(); ++row)
      if (size_t(variant[row]) == v) values.push_back(finite_or_infinite(y[row]));
    std::vector<std::string> cells{axes[by].variants[v]};
    for (const double share : {0.5, 0.95, 1.0})
      cells.push_back(fmt::format("{:.4g}", quantile(values, share)));
    for (const Profile& p : profiles) {
      double least = INFINITY, greatest = -INFINITY;
      for (const Spread& s : p.spread[v])
        if (!std::isnan(s.median)) least = std::min(least, s.median), greatest = std::max(greatest, s.median);
      cells.push_back(least > 0 ? fmt::format("{:.2f}", greatest / least) : "—");
    }
    shown.rows.push_back(std::move(cells));
  }
  shown.caption = fmt::format(
      "{}: by what factor its median grows along each axis, from where it is least to where it is greatest.",
      report::with_unit(m.name, plan.world(0).observed.units[metric]));
  return shown;
}

}  // namespace loopwright
