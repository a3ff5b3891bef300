#include <algorithm>
#include <cmath>
#include <map>
#include "tools/draw/block_face.h"

namespace loopwright {
namespace {

using Stroke = std::vector<std::pair<double, double>>;
using Strokes = std::vector<Stroke>;

Stroke sampled(double (*function)(double)) {
  constexpr int pieces = 40;
  Stroke stroke;
  for (int i = 0; i <= pieces; ++i) {
    const double x = -1 + 2.0 * i / pieces;
    stroke.emplace_back(x, function(x));
  }
  return stroke;
}

Stroke noise() {
  // A fixed picture of noise.
  static constexpr double heights[] = {0.1, -0.5, 0.7, -0.2, 0.4, -0.8, 0.2, 0.6, -0.4, 0.9, -0.6, 0.3, -0.1};
  Stroke stroke;
  for (size_t i = 0; i < std::size(heights); ++i) stroke.emplace_back(-1 + double(i) / 6, 0.8 * heights[i]);
  return stroke;
}

Stroke stairs(int steps) {
  Stroke stroke;
  for (int i = 0; i < steps; ++i) {
    const double y = -0.8 + 1.6 * i / (steps - 1);
    stroke.emplace_back(-1 + 2.0 * i / steps, y);
    stroke.emplace_back(-1 + 2.0 * (i + 1) / steps, y);
  }
  return stroke;
}

/// The table of a lookup itself.
Strokes table(const ShownSettings& s) {
  const std::vector<double> x = s.numbers("breakpoints"), y = s.numbers("values");
  if (x.size() != y.size() || x.size() < 2) return {};
  const auto [low, high] = std::ranges::minmax(y);
  const double span_x = x.back() - x.front(), span_y = high - low;
  if (!(span_x > 0)) return {};
  Stroke stroke;
  const size_t stride = std::max<size_t>(1, x.size() / 60);
  for (size_t i = 0; i < x.size(); i += stride)
    stroke.emplace_back(-1 + 2 * (x[i] - x.front()) / span_x,
                        span_y > 0 ? -0.9 + 1.8 * (y[i] - low) / span_y : 0);
  return {stroke};
}

/// Typical signals and characteristics that do not depend on parameters.
const std::map<std::string_view, Strokes>& fixed() {
  static const std::map<std::string_view, Strokes> strokes{
      {"Step", {{{-1, -0.7}, {-0.2, -0.7}, {-0.2, 0.7}, {1, 0.7}}}},
      {"Ramp", {{{-1, -0.7}, {-0.4, -0.7}, {0.6, 0.7}, {1, 0.7}}}},
      {"Sine", {sampled([](double x) { return 0.8 * std::sin(6.283 * x); })}},
      {"Chirp", {sampled([](double x) { return 0.8 * std::sin(9 * std::pow((x + 1) / 2, 2) * 2); })}},
      {"Multisine", {sampled([](double x) { return 0.45 * (std::sin(4 * x) + std::sin(11 * x + 1)); })}},
      {"PulseTrain",
       {{{-1, -0.7},
         {-0.7, -0.7},
         {-0.7, 0.7},
         {-0.2, 0.7},
         {-0.2, -0.7},
         {0.3, -0.7},
         {0.3, 0.7},
         {0.8, 0.7},
         {0.8, -0.7},
         {1, -0.7}}}},
      {"Noise", {noise()}},
      {"Clock", {{{-1, -0.8}, {1, 0.8}}}},
      {"MotionProfile", {sampled([](double x) { return 0.8 * std::tanh(3 * x); })}},
      {"PointToPoint", {sampled([](double x) { return 0.8 * std::tanh(3 * x); })}},
      {"SynchronizedMotion", {sampled([](double x) { return 0.8 * std::tanh(3 * x); }), sampled([](double x) {
                                return 0.5 * std::tanh(3 * x);
                              })}},
      {"ViaPoints", {{{-0.9, -0.7}, {-0.5, 0.4}, {0.4, 0.7}, {0.9, -0.4}}}},
      {"RecordedColumn", {noise()}},
      {"Saturation", {{{-1, -0.7}, {-0.5, -0.7}, {0.5, 0.7}, {1, 0.7}}}},
      {"ForceSaturation", {sampled([](double x) { return 0.8 * std::tanh(2 * x); })}},
      {"RateLimiter", {{{-1, -0.7}, {-0.5, -0.7}, {0.5, 0.7}, {1, 0.7}}, {{-0.1, -0.7}, {-0.1, 0.7}}}},
      {"DeadZone", {{{-1, -0.7}, {-0.35, 0}, {0.35, 0}, {1, 0.7}}}},
      {"Relay", {{{-1, -0.7}, {0.35, -0.7}, {0.35, 0.7}}, {{1, 0.7}, {-0.35, 0.7}, {-0.35, -0.7}}}},
      {"Quantizer", {stairs(5)}},
      {"Encoder", {stairs(5)}},
      {"ZeroOrderHold", {stairs(4)}},
      {"SampleAndHold", {stairs(4)}},
      {"Sign", {{{-1, -0.7}, {0, -0.7}, {0, 0.7}, {1, 0.7}}}},
      {"Backlash", {{{-0.9, -0.7}, {0.4, -0.7}, {0.9, 0.7}, {-0.4, 0.7}, {-0.9, -0.7}}}},
      {"BacklashCoupling", {{{-1, -0.8}, {-0.35, 0}, {0.35, 0}, {1, 0.8}}}},
      {"EndStop", {{{-1, -0.9}, {-0.7, 0}, {0.7, 0}, {1, 0.9}}}},
      {"ViscousFriction", {{{-0.9, -0.7}, {0.9, 0.7}}}},
      {"Spring", {{{-0.9, -0.7}, {0.9, 0.7}}}},
      {"HardeningSpring", {sampled([](double x) { return 0.3 * x + 0.55 * x * x * x; })}},
      {"QuadraticDrag", {sampled([](double x) { return 0.8 * x * std::abs(x); })}},
      {"EddyCurrentDrag", {sampled([](double x) { return 1.6 * x * 0.45 / (0.2 + x * x); })}},
      {"CoulombFriction", {{{-1, -0.6}, {0, -0.6}, {0, 0.6}, {1, 0.6}}}},
      {"SmoothCoulombFriction", {sampled([](double x) { return 0.6 * std::tanh(6 * x); })}},
      {"DirectionDependentFriction", {{{-1, -0.4}, {0, -0.4}, {0, 0.75}, {1, 0.75}}}},
      {"StribeckFriction",
       {{{-1, -0.45},
         {-0.6, -0.45},
         {-0.3, -0.55},
         {-0.12, -0.8},
         {0, -0.9},
         {0, 0.9},
         {0.12, 0.8},
         {0.3, 0.55},
         {0.6, 0.45},
         {1, 0.45}}}},
      {"LuGreFriction",
       {{{-0.9, -0.7}, {0.1, -0.55}, {0.6, 0.2}, {0.9, 0.7}, {-0.1, 0.55}, {-0.6, -0.2}, {-0.9, -0.7}}}},
      {"DahlFriction",
       {{{-0.9, -0.7}, {0.1, -0.55}, {0.6, 0.2}, {0.9, 0.7}, {-0.1, 0.55}, {-0.6, -0.2}, {-0.9, -0.7}}}},
      {"PreslidingFriction",
       {{{-0.9, -0.7}, {0.1, -0.55}, {0.6, 0.2}, {0.9, 0.7}, {-0.1, 0.55}, {-0.6, -0.2}, {-0.9, -0.7}}}},
      {"CoggingForce", {sampled([](double x) { return 0.7 * std::sin(9.42 * x); })}},
      {"ForceRipple", {sampled([](double x) { return 0.4 + 0.25 * std::sin(12.5 * x); })}},
      {"ThermalDrift", {sampled([](double x) { return 0.7 - 1.4 * std::exp(-2 * (x + 1)); })}},
  };
  return strokes;
}

}  // namespace

std::vector<std::vector<std::pair<double, double>>> characteristic(const ShownSettings& settings) {
  if (settings.type() == "Lookup1D") return table(settings);
  const auto found = fixed().find(settings.type());
  return found == fixed().end() ? Strokes() : found->second;
}

}  // namespace loopwright
