#include "tools/gp/surface_picture.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "models/real/whole.h"
#include "tools/report/typography.h"

namespace loopwright {
namespace {

constexpr double width = 860, height = 470;
constexpr int cells_x = 200, cells_v = 16;

struct Spot {
  double x, y;
};

/// From the box of position, velocity and label to the drawing: velocity points back and to the right.
struct View {
  gp::Range position, velocity, label;
  double along(const gp::Range& range, double value) const {
    return (value - range.low) / std::max(range.high - range.low, 1e-300);
  }
  Spot of(double x, double v, double y) const {
    const double depth = along(velocity, v);
    return {60 + 600 * along(position, x) + 150 * depth, 420 - 130 * depth - 250 * along(label, y)};
  }
};

/// Blue through gray to orange, distinguishable also with color blindness.
std::string colour(double share) {
  static constexpr double stops[3][3] = {{11, 98, 176}, {214, 214, 210}, {207, 74, 22}};
  const double at = 2 * std::clamp(share, 0.0, 1.0);
  const int i = at < 1 ? 0 : 1;
  int rgb[3];
  for (int k = 0; k < 3; ++k)
    rgb[k] = whole_between(std::round(stops[i][k] + (at - i) * (stops[i + 1][k] - stops[i][k])), 0, 255);
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

void add_text(std::string& svg, Spot at, const char* anchor, const std::string& text) {
  svg +=
      fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", at.x, at.y, anchor, text);
}
void add_line(std::string& svg, Spot a, Spot b) {
  svg += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", a.x, a.y, b.x, b.y);
}

void add_axes(std::string& svg, const View& view, const std::string& unit) {
  const auto& [x, v, y] = view;
  svg += "<g stroke=\"currentColor\" stroke-opacity=\"0.35\" fill=\"none\">\n";
  add_line(svg, view.of(x.low, v.low, y.low), view.of(x.high, v.low, y.low));
  add_line(svg, view.of(x.high, v.low, y.low), view.of(x.high, v.high, y.low));
  add_line(svg, view.of(x.low, v.low, y.low), view.of(x.low, v.low, y.high));
  add_line(svg, view.of(x.low, v.low, y.low), view.of(x.low, v.high, y.low));
  add_line(svg, view.of(x.low, v.high, y.low), view.of(x.high, v.high, y.low));
  svg += "</g>\n<g fill=\"currentColor\" font-size=\"12\">\n";
  for (int i = 0; i <= 4; ++i) {
    const double at = x.low + (x.high - x.low) * i / 4;
    const Spot spot = view.of(at, v.low, y.low);
    add_text(svg, {spot.x, spot.y + 18}, "middle", fmt::format("{:.0f}", 1e3 * at));
  }
  for (int i = 0; i <= 2; ++i) {
    const double at = v.low + (v.high - v.low) * i / 2;
    const Spot spot = view.of(x.high, at, y.low);
    add_text(svg, {spot.x + 10, spot.y + 6}, "start", fmt::format("{:.3g}", at));
    const double level = y.low + (y.high - y.low) * i / 2;
    const Spot side = view.of(x.low, v.low, level);
    add_text(svg, {side.x - 8, side.y + 4}, "end", fmt::format("{:.2g}", level));
  }
  const Spot middle = view.of(0.5 * (x.low + x.high), v.low, y.low);
  add_text(svg, {middle.x, middle.y + 38}, "middle", "Position (mm)");
  const Spot right = view.of(x.high, 0.5 * (v.low + v.high), y.low);
  add_text(svg, {right.x + 20, right.y + 34}, "start", "Velocity (m/s)");
  add_text(svg, {20, 20}, "start", unit.empty() ? "Disturbance" : fmt::format("Disturbance ({})", unit));
  svg += "</g>\n";
}

}  // namespace

report::Picture surface_picture(const gp::MeanTable& mean, const gp::Samples& samples,
                                const SurfaceOptions& options) {
  View view{options.position, options.velocity, {1e300, -1e300}};
  if (!(view.velocity.high > view.velocity.low)) view.velocity.low -= 0.05, view.velocity.high += 0.05;
  const auto x_at = [&](int i) {
    return view.position.low + (view.position.high - view.position.low) * i / cells_x;
  };
  const auto v_at = [&](int j) {
    return view.velocity.low + (view.velocity.high - view.velocity.low) * j / cells_v;
  };
  const auto widen = [&](double y) {
    view.label.low = std::min(view.label.low, y), view.label.high = std::max(view.label.high, y);
  };
  for (int j = 0; j <= cells_v; ++j)
    for (int i = 0; i <= cells_x; ++i) widen(mean({x_at(i), v_at(j)}));
  for (double y : samples.labels) widen(y);

  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {} {}\" style=\"min-width:{}px\" xmlns=\"http://www.w3.org/2000/svg\" role=\"img\">\n",
      width, height, report::least_scale * width);
  add_axes(svg, view, options.label_unit);
  // From back to front, rows of the mesh and the samples between them.
  for (int j = cells_v - 1; j >= 0; --j) {
    const double back = v_at(j + 1), front = v_at(j);
    svg += "<g stroke-width=\"0.3\">\n";
    for (int i = 0; i < cells_x; ++i) {
      const double corners[4][2] = {
          {x_at(i), front}, {x_at(i + 1), front}, {x_at(i + 1), back}, {x_at(i), back}};
      std::string points;
      double level = 0;
      for (const auto& c : corners) {
        const double y = mean({c[0], c[1]});
        const Spot spot = view.of(c[0], c[1], y);
        points += fmt::format("{:.1f},{:.1f} ", spot.x, spot.y);
        level += 0.25 * view.along(view.label, y);
      }
      const std::string fill = colour(level);
      svg += fmt::format("<polygon points=\"{}\" fill=\"{}\" stroke=\"{}\"/>\n", points, fill, fill);
    }
    svg += "</g>\n<g fill=\"currentColor\" fill-opacity=\"0.55\">\n";
    for (size_t k = 0; k < samples.labels.size(); ++k) {
      const auto [x, v] = samples.inputs[k];
      const bool is_here = v >= front && (v < back || (j == cells_v - 1 && v <= back));
      if (!is_here || x < view.position.low || x > view.position.high) continue;
      const Spot spot = view.of(x, v, samples.labels[k]);
      svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.1\"/>\n", spot.x, spot.y);
    }
    svg += "</g>\n";
  }
  return {svg + "</svg>\n", "",
          fmt::format(
              "Disturbance from {:.3g} to {:.3g} {} over positions {:.0f} to {:.0f} mm and velocities {:.3g} "
              "to {:.3g} m/s.",
              view.label.low, view.label.high, options.label_unit, 1e3 * view.position.low,
              1e3 * view.position.high, view.velocity.low, view.velocity.high)};
}

}  // namespace loopwright
