#include "tools/report/waterfall.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include "tools/report/typography.h"
#include "models/real/whole.h"

namespace loopwright::report {
namespace {

// The picture in its own coordinates: the floor is sheared, y goes up and to the right.
constexpr double width = 720, height = 400, left = 62, bottom = 340;
constexpr double across = 470, shear = 150, depth = 120, rise = 150;

struct Range {
  double low = 0, high = 1;
  double share(double value) const { return (value - low) / (high - low); }
};

Range range_of(const std::vector<double>& values) {
  if (values.empty()) return {};
  const auto [low, high] = std::ranges::minmax_element(values);
  return *low < *high ? Range{*low, *high} : Range{*low - 0.5, *low + 0.5};
}

struct Point {
  double x, y;
};

/// The value at a fraction of a range, to a hundredth of the range.
std::string number(const Range& range, double share) {
  const int decimals = whole_between(2 - std::floor(std::log10(range.high - range.low)), 0, 300);
  std::string text = fmt::format("{:.{}f}", range.low + share * (range.high - range.low), decimals);
  if (decimals > 0) text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

class Drawing {
 public:
  explicit Drawing(const Waterfall& waterfall) : w(waterfall) {
    std::vector<double> along_x = w.x_values, along_y = w.y_values, heights;
    const auto add = [](std::vector<double>& to, const std::vector<double>& values) {
      to.insert(to.end(), values.begin(), values.end());
    };
    for (const auto& curve : w.z_values) add(heights, curve);
    for (const auto& cloud : w.clouds) add(along_x, cloud.x), add(along_y, cloud.y), add(heights, cloud.z);
    x = range_of(along_x), y = range_of(along_y);
    z = w.z_low < w.z_high ? Range{w.z_low, w.z_high} : range_of(heights);
  }

  std::string svg() {
    text = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" style=\"max-width:{}px;min-width:{}px\">", width,
                       height, width, least_scale * width);
    floor();
    for (size_t j = w.y_values.size(); j-- > 0;) {  // from the back to the front
      curve(j);
      const double front = j > 0 ? w.y_values[j - 1] : -INFINITY;
      for (size_t c = 0; c < w.clouds.size(); ++c)
        if (!w.clouds[c].joined) dots(c, front, w.y_values[j]);
    }
    for (size_t c = 0; c < w.clouds.size(); ++c)
      if (w.clouds[c].joined) line(c);
    axes();
    legend();
    return text + "</svg>";
  }

 private:
  const Waterfall& w;
  Range x, y, z;
  std::string text;

  Point at(double px, double py, double pz) const {
    const double back = y.share(py);
    return {left + across * x.share(px) + shear * back,
            bottom - depth * back - rise * std::clamp(z.share(pz), -0.2, 1.2)};
  }
  void path(const std::vector<Point>& points, std::string_view style) {
    text += "<path d=\"";
    for (size_t i = 0; i < points.size(); ++i)
      text += fmt::format("{}{:.1f} {:.1f}", i ? "L" : "M", points[i].x, points[i].y);
    text += fmt::format("\" style=\"{}\"/>", style);
  }
  void label(Point p, std::string_view words, std::string_view anchor, double angle = 0) {
    text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"", p.x, p.y, anchor);
    if (angle != 0) text += fmt::format(" transform=\"rotate({:.1f} {:.1f} {:.1f})\"", angle, p.x, p.y);
    text += fmt::format(" style=\"fill:var(--soft);font-size:12px\">{}</text>", escape_html(words));
  }
  void floor() {
    path({at(x.low, y.low, z.low), at(x.high, y.low, z.low), at(x.high, y.high, z.low),
          at(x.low, y.high, z.low), at(x.low, y.low, z.low)},
         "fill:var(--panel);stroke:var(--rule)");
  }
  void curve(size_t j) {
    std::vector<Point> points;
    for (size_t i = 0; i < w.x_values.size(); ++i)
      points.push_back(at(w.x_values[i], w.y_values[j], w.z_values[j][i]));
    std::vector<Point> area = points;
    area.push_back(at(w.x_values.back(), w.y_values[j], z.low));
    area.push_back(at(w.x_values.front(), w.y_values[j], z.low));
    path(area, "fill:var(--paper);fill-opacity:0.85;stroke:none");
    path(points, "fill:none;stroke:var(--series-7);stroke-width:1.1");
  }
  void dots(size_t c, double front, double back) {
    const auto& cloud = w.clouds[c];
    std::string d;
    for (size_t i = 0; i < cloud.x.size(); ++i) {
      if (cloud.y[i] <= front || cloud.y[i] > back) continue;
      const Point p = at(cloud.x[i], cloud.y[i], cloud.z[i]);
      d += fmt::format("M{:.1f} {:.1f}h0", p.x, p.y);
    }
    if (!d.empty())
      text += fmt::format(
          "<path d=\"{}\" style=\"fill:none;stroke:var(--series-{});stroke-width:2.2;stroke-linecap:round;"
          "stroke-opacity:0.55\"/>",
          d, c);
  }
  void line(size_t c) {
    std::vector<Point> points;
    const auto& cloud = w.clouds[c];
    for (size_t i = 0; i < cloud.x.size(); ++i) points.push_back(at(cloud.x[i], cloud.y[i], cloud.z[i]));
    path(points, fmt::format("fill:none;stroke:var(--series-{});stroke-width:1.6", c));
  }
  void axes() {
    for (const double s : {0.0, 0.5, 1.0}) {
      Point p = at(x.low + s * (x.high - x.low), y.low, z.low);
      label({p.x, p.y + 16}, number(x, s), "middle");
      p = at(x.high, y.low + s * (y.high - y.low), z.low);
      label({p.x + 8, p.y + 4}, number(y, s), "start");
      p = at(x.low, y.low, z.low + s * (z.high - z.low));
      label({p.x - 6, p.y + 4}, number(z, s), "end");
    }
    path({at(x.low, y.low, z.low), at(x.low, y.low, z.high)}, "fill:none;stroke:var(--soft)");
    path({at(x.low, y.low, z.low), at(x.high, y.low, z.low), at(x.high, y.high, z.low)},
         "fill:none;stroke:var(--soft)");
    const auto named = [](const Axis& axis) { return with_unit(axis.label, axis.unit); };
    const Point middle = at(0.5 * (x.low + x.high), y.low, z.low),
                side = at(x.high, 0.5 * (y.low + y.high), z.low),
                up = at(x.low, y.low, 0.5 * (z.low + z.high));
    label({middle.x, middle.y + 36}, named(w.x), "middle");
    label({side.x + 46, side.y + 14}, named(w.y), "middle", -180 / 3.14159265 * std::atan2(depth, shear));
    label({up.x - 42, up.y}, named(w.z), "middle", -90);
  }
  void legend() {
    double from = left;
    for (size_t c = 0; c < w.clouds.size(); ++c) {
      text +=
          fmt::format("<circle cx=\"{:.0f}\" cy=\"14\" r=\"4\" style=\"fill:var(--series-{})\"/>", from, c);
      label({from + 9, 18}, w.clouds[c].name, "start");
      from += 28 + 7.0 * double(text_width(w.clouds[c].name));
    }
  }
};

void check(const Waterfall& w) {
  bool fits = w.z_values.size() == w.y_values.size();
  for (const auto& curve : w.z_values) fits &= curve.size() == w.x_values.size();
  for (const auto& cloud : w.clouds)
    fits &= cloud.x.size() == cloud.y.size() && cloud.x.size() == cloud.z.size();
  if (!fits) throw std::invalid_argument("waterfall \"" + w.title + "\": lists of different lengths");
}

}  // namespace

Picture waterfall_picture(const Waterfall& waterfall) {
  check(waterfall);
  Picture picture;
  picture.svg = Drawing(waterfall).svg();
  picture.caption = waterfall.title;
  if (!waterfall.caption.empty())
    picture.caption += (picture.caption.empty() ? "" : ". ") + waterfall.caption;
  double low = INFINITY, high = -INFINITY;
  for (const auto& curve : waterfall.z_values)
    for (double value : curve) low = std::min(low, value), high = std::max(high, value);
  picture.text = fmt::format("{} over {} and {}: {:.4g} … {:.4g} {}", waterfall.z.label, waterfall.x.label,
                             waterfall.y.label, low, high, waterfall.z.unit);
  return picture;
}

}  // namespace loopwright::report
