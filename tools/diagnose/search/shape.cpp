#include "tools/diagnose/search/shape.h"
#include <algorithm>
#include <cmath>
#include <numbers>
#include "tools/diagnose/search/first_values.h"

namespace loopwright::diagnosis {
namespace {

using enum Quantity;
using namespace first_values;

// The places where a shape makes sense. Flows and heat follow few laws; a signal without a unit may be
// anything.
bool everywhere(Quantity, Quantity) { return true; }
bool smooth(Quantity site, Quantity) { return site != flow && site != heat; }
bool moving(Quantity site, Quantity s) {
  return site != flow && site != heat && (s == velocity || s == other);
}
bool resisting(Quantity site, Quantity s) { return (site == force || site == other) && s == velocity; }
bool placed(Quantity site, Quantity s) {
  return site != flow && site != heat && (s == position || s == other);
}
bool turning(Quantity site, Quantity s) { return site != flow && site != heat && s == position; }
bool electric(Quantity, Quantity s) { return s == current || s == voltage || s == other; }
bool over_level(Quantity site, Quantity s) {
  return s == position || s == other || (site == heat && s == temperature);
}
bool outflow(Quantity site, Quantity s) {
  return (site == flow || site == other) && (s == position || s == other);  // of a level, or of a pressure
}
bool nowhere(Quantity, Quantity) { return false; }
bool warm(Quantity site, Quantity s) { return site == heat && s == temperature; }

/// dz = (dx - |dx| z) / distance, from z before to z after a path in one direction.
double dahl_along(double before, double path, double distance) {
  const double end = path < 0 ? -1 : 1;
  return end + (before - end) * std::exp(-std::abs(path) / distance);
}

/// The same while the velocity changes evenly `from` one value `to` another; it may turn on the way.
double dahl(double before, double from, double to, double time, const double* p) {
  if (from * to >= 0) return dahl_along(before, (from + to) / 2 * time, p[0]);
  const double until_turn = from / (from - to) * time;
  return dahl_along(dahl_along(before, from / 2 * until_turn, p[0]), to / 2 * (time - until_turn), p[0]);
}

double sign_of(double s) { return s < 0 ? -1 : 1; }
double clipped(double s, double limit) { return std::clamp(s, -std::abs(limit), std::abs(limit)); }

const TermShape known_shapes[] = {
    {"constant",
     "A constant",
     "",
     TermShape::Of::nothing,
     1,
     0,
     {"value"},
     0,
     [](double, const double*, double* c) { c[0] = 1; },
     {},
     everywhere},
    {"linear",
     "In proportion",
     "",
     TermShape::Of::signal,
     1,
     1,
     {"slope"},
     1,
     [](double s, const double*, double* c) { c[0] = s; },
     {},
     everywhere},
    {.name = "sign",
     .title = "Dry friction: a constant size, the sign of the signal",
     .formula = "level*tanh(signal/width)",
     .coefficients = {"level"},
     .evaluate = [](double s, const double* p, double* c) { c[0] = std::tanh(s / p[0]); },
     .nonlinear = {"width"},
     .fits = moving,
     .starts = widths,
     .has_front = true},
    {.name = "stribeck",
     .title = "Dry friction that falls with speed",
     .formula = "tanh(signal/width)*(sliding_level + breakaway_excess*exp(-(signal/fall_speed)^2))",
     .columns = 2,
     .cost = 2,
     .coefficients = {"sliding_level", "breakaway_excess"},
     .evaluate =
         [](double s, const double* p, double* c) {
           const double x = s / p[1];
           c[0] = std::tanh(s / p[0]), c[1] = c[0] * std::exp(-x * x);
         },
     .nonlinear = {"width", "fall_speed"},
     .fits = moving,
     .starts = stribeck_speeds,
     .has_front = true},
    {.name = "hysteresis",
     .title = "Dry friction that builds up over a distance after each reversal (Dahl)",
     .cost = 3,
     .coefficients = {"level"},
     .nonlinear = {"transition_distance"},
     .fits = resisting,
     .starts = distances,
     .ranges = ranges_of_distance,
     .remembered = dahl},
    {"signed_square",
     "The square with the sign of the signal, as drag",
     "coefficient*signal*abs(signal)",
     TermShape::Of::signal,
     1,
     0,
     {"coefficient"},
     2,
     [](double s, const double*, double* c) { c[0] = s * std::abs(s); },
     {},
     smooth},
    {"square",
     "The square",
     "coefficient*signal^2",
     TermShape::Of::signal,
     1,
     1,
     {"coefficient"},
     2,
     [](double s, const double*, double* c) { c[0] = s * s; },
     {},
     smooth},
    {"cube",
     "The cube, as of a hardening spring",
     "coefficient*signal^3",
     TermShape::Of::signal,
     1,
     1,
     {"coefficient"},
     3,
     [](double s, const double*, double* c) { c[0] = s * s * s; },
     {},
     smooth},
    {"absolute",
     "The absolute value",
     "coefficient*abs(signal)",
     TermShape::Of::signal,
     1,
     1,
     {"coefficient"},
     1,
     [](double s, const double*, double* c) { c[0] = std::abs(s); },
     {},
     moving},
    {"periodic",
     "Periodic, as cogging",
     "sine*sin(2*pi*signal/pitch) + cosine*cos(2*pi*signal/pitch)",
     TermShape::Of::signal,
     2,
     4,
     {"sine", "cosine"},
     0,
     [](double s, const double* p, double* c) {
       const double phase = 2 * std::numbers::pi * s / p[0];
       c[0] = std::sin(phase), c[1] = std::cos(phase);
     },
     {"pitch"},
     turning,
     pitches},
    {"overflow",
     "What exceeds a level",
     "slope*max(0, signal - level)",
     TermShape::Of::signal,
     1,
     2,
     {"slope"},
     1,
     [](double s, const double* p, double* c) { c[0] = std::max(0.0, s - p[0]); },
     {"level"},
     over_level,
     levels},
    {"underflow",
     "What falls short of a level",
     "slope*min(0, signal - level)",
     TermShape::Of::signal,
     1,
     2,
     {"slope"},
     1,
     [](double s, const double* p, double* c) { c[0] = std::min(0.0, s - p[0]); },
     {"level"},
     placed,
     levels_above},
    {"square_root",
     "The square root, as an outflow",
     "coefficient*sign(signal)*sqrt(abs(signal))",
     TermShape::Of::signal,
     1,
     1,
     {"coefficient"},
     0.5,
     [](double s, const double*, double* c) { c[0] = sign_of(s) * std::sqrt(std::abs(s)); },
     {},
     outflow},
    {"soft_sign",
     "A drop that saturates, as of brushes",
     "level*tanh(signal/knee)",
     TermShape::Of::signal,
     1,
     2,
     {"level"},
     0,
     [](double s, const double* p, double* c) { c[0] = std::tanh(s / p[0]); },
     {"knee"},
     electric,
     knees},
    {"radiation",
     "Radiation: the fourth power of a temperature, and a constant",
     "at_300_kelvin*(signal/reference)^4 + constant",
     TermShape::Of::signal,
     2,
     1,
     {"at_300_kelvin", "constant"},
     0,
     [](double s, const double*, double* c) {
       const double x = s / 300;  // so that both columns are of similar size
       c[0] = x * x * x * x, c[1] = 1;
     },
     {},
     warm},
    {"convection",
     "Free convection: the power 1.25 of a temperature difference",
     "coefficient*sign(signal)*abs(signal)^1.25",
     TermShape::Of::signal,
     1,
     1,
     {"coefficient"},
     1.25,
     [](double s, const double*, double* c) { c[0] = sign_of(s) * std::pow(std::abs(s), 1.25); },
     {},
     warm},
    {"saturation",
     "A limit of the signal",
     "max(-limit, min(limit, signal)) - signal",
     TermShape::Of::own,
     1,
     0,
     {},
     0,
     [](double s, const double* p, double* c) { c[0] = clipped(s, p[0]) - s; },
     {"limit"},
     everywhere,
     knees},
    {"dead_zone",
     "A dead zone of the signal",
     "-max(-half_width, min(half_width, signal))",
     TermShape::Of::own,
     1,
     0,
     {},
     0,
     [](double s, const double* p, double* c) { c[0] = -clipped(s, p[0]); },
     {"half_width"},
     everywhere,
     knees},
    {.name = "delay",
     .title = "A delay of the input",
     .of = TermShape::Of::past,
     .cost = 1,
     .nonlinear = {"delay", "input_before"},
     .fits = nowhere,
     .starts = waits,
     .late = delayed},
    {.name = "lag",
     .title = "A first-order lag of the input",
     .of = TermShape::Of::past,
     .cost = 1,
     .nonlinear = {"time_constant", "input_before"},
     .fits = nowhere,
     .starts = waits,
     .late = lagged},
};

/// A signal between two nodes of a grid over the range [p0, p1].
struct Between {
  int left = 0;
  double share = 0;  ///< of the right node; NaN if the signal or the range is none
  Between(int nodes, double s, const double* p) {
    share = std::clamp((s - p[0]) / (p[1] - p[0]), 0.0, 1.0) * (nodes - 1);
    if (!std::isfinite(share)) return;
    left = std::min(int(share), nodes - 2), share -= left;
  }
};
/// Hats: one column for each node.
void hats(int nodes, double s, const double* p, double* c) {
  const Between at(nodes, s, p);
  std::fill(c, c + nodes, 0.0);
  c[at.left] = 1 - at.share, c[at.left + 1] = at.share;
}
Starts range(std::span<const double> signal) {
  const auto [low, high] = std::ranges::minmax(signal);
  return {{low, high}};
}

TermShape unknown_of(int nodes) {
  constexpr double cost = 6;  // nats
  TermShape shape{"unknown", "A function without a name", ""};
  shape.columns = nodes, shape.cost = cost, shape.fits = everywhere, shape.starts = range;
  shape.evaluate = [nodes](double s, const double* p, double* c) { hats(nodes, s, p, c); };
  shape.value = [nodes](double s, const double* p, const double* c) {
    const Between at(nodes, s, p);
    return c[at.left] + at.share * (c[at.left + 1] - c[at.left]);
  };
  return shape;
}

const TermShape unknown_shapes[] = {unknown_of(9), unknown_of(17), unknown_of(most_columns)};

}  // namespace

std::span<const TermShape> named_shapes() { return known_shapes; }
std::span<const TermShape> unknown_functions() { return unknown_shapes; }
bool is_dry_friction(const TermShape& shape) {
  return shape.name == "sign" || shape.name == "stribeck" || shape.remembered;
}
bool is_unknown_function(const TermShape& shape) {
  return std::ranges::any_of(unknown_shapes, [&](const TermShape& known) { return &known == &shape; });
}

}  // namespace loopwright::diagnosis
