#include <fmt/format.h>
#include <cmath>
#include <numbers>
#include "tools/linearize/analysis.h"
#include "tools/linearize/nyquist.h"

namespace loopwright {
namespace {

using Eigen::Index;
using report::Series;
using Complex = std::complex<double>;
using std::numbers::pi;

std::vector<double> in_hertz(const std::vector<double>& frequency) {
  std::vector<double> hertz;
  for (double f : frequency) hertz.push_back(f / (2 * pi));
  return hertz;
}
/// 20 log₁₀ |G|; no gain is a gap.
std::vector<double> decibels(const std::vector<Complex>& response) {
  std::vector<double> gain;
  for (const Complex& value : response)
    gain.push_back(std::abs(value) > 0 ? 20 * std::log10(std::abs(value)) : std::nan(""));
  return gain;
}

struct Bode {
  report::Plot gain, phase;
  explicit Bode(const std::string& unit) {
    gain.x = phase.x = {"Frequency", "Hz", true};
    gain.y = {unit.empty() ? "Gain" : fmt::format("Gain, 0 dB = 1 {}", unit), "dB", false},
    phase.y = {"Phase", "°", false};
    gain.group = phase.group = "frequency";
  }
  void add(const std::string& name, const std::vector<double>& frequency,
           const std::vector<Complex>& response, Series::Shape shape = Series::Shape::line) {
    gain.series.push_back({name, in_hertz(frequency), decibels(response), shape});
    phase.series.push_back({name, in_hertz(frequency), unwrapped_degrees(response), shape});
  }
};

std::string gain_unit(const LinearAnalysis& a, size_t input, size_t output) {
  const std::string &in = a.system.input_units[input], &out = a.system.output_units[output];
  if (in.empty() || out.empty() || in == out) return "";
  return in.find_first_of("*/^") == in.npos ? fmt::format("{}/{}", out == "1" ? "1" : out, in)
                                            : fmt::format("{}/({})", out, in);
}

report::Section responses(const LinearAnalysis& analysis) {
  report::Section section{"Frequency response", {}};
  if (analysis.measured.size() < analysis.sines)
    section.items.push_back(report::Notice{
        report::Notice::Severity::warning,
        fmt::format("Interrupted: {} of {} sines were measured.", analysis.measured.size(), analysis.sines)});
  for (size_t i = 0; i < analysis.system.inputs.size(); ++i)
    for (size_t o = 0; o < analysis.system.outputs.size(); ++o) {
      const std::string name = fmt::format("{} → {}", analysis.system.inputs[i], analysis.system.outputs[o]);
      Bode bode(gain_unit(analysis, i, o));
      bode.gain.title = "Gain of " + name, bode.phase.title = "Phase of " + name;
      bode.add("linearized", analysis.frequency, channel_response(analysis, Index(i), Index(o)));
      if (i == 0 && o == 0 && !analysis.measured.empty()) {
        std::vector<double> frequency;
        std::vector<Complex> response;
        for (const MeasuredPoint& point : analysis.measured)
          frequency.push_back(point.frequency), response.push_back(point.response);
        bode.add("measured by simulated sines", frequency, response, Series::Shape::points);
      }
      section.items.push_back(std::move(bode.gain));
      section.items.push_back(std::move(bode.phase));
    }
  return section;
}

std::string decibels(double gain) { return fmt::format("{:.3g}", 20 * std::log10(gain)); }

/// Crossovers and margins as lines: where |L| is 0 dB the phase margin is read, where the phase is -180° the
/// gain margin.
void mark_margins(const Margins& m, Bode& bode) {
  using report::Mark;
  bode.gain.marks.push_back({Mark::Along::y, 0, "0 dB"});
  bode.phase.marks.push_back({Mark::Along::y, -180, "−180°"});
  const auto add = [&](double frequency, const std::string& gain, const std::string& phase) {
    if (!std::isfinite(frequency) || frequency <= 0) return;
    bode.gain.marks.push_back({Mark::Along::x, frequency / (2 * pi), gain});
    bode.phase.marks.push_back({Mark::Along::x, frequency / (2 * pi), phase});
  };
  if (std::isfinite(m.phase))
    add(m.phase_frequency, fmt::format("crossover {:.4g} Hz", m.phase_frequency / (2 * pi)),
        fmt::format("phase margin {:.1f}°", m.phase * 180 / pi));
  if (std::isfinite(m.gain))
    add(m.gain_frequency, "gain margin " + decibels(m.gain) + " dB",
        fmt::format("−180° at {:.4g} Hz", m.gain_frequency / (2 * pi)));
  if (m.lower_gain > 0)
    add(m.lower_gain_frequency, "lower gain margin " + decibels(m.lower_gain) + " dB",
        fmt::format("−180° at {:.4g} Hz", m.lower_gain_frequency / (2 * pi)));
}

report::Notice verdict(const LoopAnalysis& loop) {
  using Severity = report::Notice::Severity;
  if (!loop.is_loop()) return {Severity::warning, "No signal returns to this port: it is in no loop."};
  switch (loop.margins.stability) {
    case Stability::stable:
      return {Severity::good, "The closed loop is stable."};
    case Stability::boundary:
      return {Severity::error,
              "The closed loop is at the boundary of stability: one of its modes does not decay."};
    case Stability::unstable:
      break;
  }
  return {Severity::error, "The closed loop is unstable."};
}

report::Section loop_section(const LoopAnalysis& loop) {
  const Margins& m = loop.margins;
  report::Section section{fmt::format("Loop cut at {}", loop.port), {}};
  section.items.push_back(verdict(loop));
  for (const std::string& mode : loop.outside)
    section.items.push_back(report::Notice{report::Notice::Severity::warning, mode});
  const auto at = [](double frequency) { return fmt::format("at {:.4g} Hz", frequency / (2 * pi)); };
  report::KeyNumbers numbers;
  if (std::isfinite(m.gain))
    numbers.numbers.push_back({"Gain margin", decibels(m.gain), "dB", at(m.gain_frequency)});
  if (m.lower_gain > 0)
    numbers.numbers.push_back(
        {"Lower gain margin", decibels(m.lower_gain), "dB", at(m.lower_gain_frequency)});
  if (std::isfinite(m.phase))
    numbers.numbers.push_back(
        {"Phase margin", fmt::format("{:.1f}", m.phase * 180 / pi), "°", at(m.phase_frequency)});
  if (std::isfinite(m.delay))
    numbers.numbers.push_back(
        {"Delay margin", fmt::format("{:.3g}", 1e3 * m.delay), "ms", at(m.delay_frequency)});
  if (std::isfinite(m.Ms))
    numbers.numbers.push_back({"Ms", fmt::format("{:.3g}", m.Ms), "", at(m.Ms_frequency)});
  section.items.push_back(std::move(numbers));
  Bode bode("");
  bode.gain.title = "Gain of the loop L and of its sensitivity";
  bode.phase.title = "Phase of the loop L";
  bode.add("L", loop.frequency, loop.response);
  if (std::vector<double>& phase = bode.phase.series[0].y; !phase.empty() && phase[0] > 0)
    for (double& value : phase) value -= 360;  // loops lag
  std::vector<Complex> sensitivity;
  for (const Complex& value : loop.response) sensitivity.push_back(1.0 / (1.0 + value));
  bode.gain.series.push_back(
      {"1/(1 + L)", in_hertz(loop.frequency), decibels(sensitivity), Series::Shape::line});
  mark_margins(m, bode);
  section.items.push_back(std::move(bode.gain));
  section.items.push_back(std::move(bode.phase));
  section.items.push_back([&] {
    report::Plot nyquist;
    nyquist.equal_axes = true;
    nyquist.title = "Nyquist";
    nyquist.x = {"Re L", "", false}, nyquist.y = {"Im L", "", false};
    NyquistCurves curves = nyquist_curves(loop);
    nyquist.caption = "Where |L| < 5.";
    nyquist.series.push_back({"L", std::move(curves.real), std::move(curves.imaginary), Series::Shape::line});
    if (!curves.circle_real.empty()) {
      nyquist.series.push_back(
          {"Ms", std::move(curves.circle_real), std::move(curves.circle_imaginary), Series::Shape::line});
      nyquist.caption += " The circle around -1 that the curve touches has the radius 1/Ms.";
    }
    nyquist.series.push_back({"-1", {-1}, {0}, Series::Shape::points});
    return nyquist;
  }());
  return section;
}

report::Table pole_table(const LinearAnalysis& analysis) {
  report::Table table;
  table.head = {analysis.is_sampled() ? "Pole in z" : "Pole in s (1/s)", "Frequency (Hz)", "Damping",
                "Time constant (ms)", "Who takes part"};
  for (const Pole& pole : analysis.poles) {
    if (pole.value.imag() < 0) continue;
    const bool finite = std::isfinite(pole.frequency) && pole.frequency > 0;
    table.rows.push_back({pole.value.imag() > 0
                              ? fmt::format("{:.6g} ± {:.6g} j", pole.value.real(), pole.value.imag())
                              : fmt::format("{:.6g}", pole.value.real()),
                          finite ? fmt::format("{:.4g}", pole.frequency / (2 * pi)) : "",
                          finite ? fmt::format("{:.4f}", pole.damping) : "",
                          finite ? fmt::format("{:.4g}", -1e3 / pole.continuous.real()) : "",
                          owners(pole, analysis.system.states)});
  }
  table.caption = "Shares are participation factors.";
  return table;
}

report::Plot pole_plot(const LinearAnalysis& analysis) {
  report::Plot plot;
  const char* plane = analysis.is_sampled() ? "z" : "s";
  const char* unit = analysis.is_sampled() ? "" : "1/s";
  plot.title = fmt::format("Poles and transmission zeros in the {} plane", plane);
  plot.caption =
      analysis.is_sampled() ? "Poles inside the circle are stable." : "Poles on the left are stable.";
  plot.x = {fmt::format("Re {}", plane), unit, false}, plot.y = {fmt::format("Im {}", plane), unit, false};
  Series poles{"poles", {}, {}, Series::Shape::points};
  for (const Pole& pole : analysis.poles)
    poles.x.push_back(pole.value.real()), poles.y.push_back(pole.value.imag());
  plot.series.push_back(std::move(poles));
  if (analysis.zeros && !analysis.zeros->empty()) {
    Series zeros{"transmission zeros", {}, {}, Series::Shape::points};
    for (const Complex& zero : *analysis.zeros)
      zeros.x.push_back(zero.real()), zeros.y.push_back(zero.imag());
    plot.series.push_back(std::move(zeros));
  }
  if (analysis.is_sampled()) {
    plot.equal_axes = true;
    Series circle{"unit circle", {}, {}, Series::Shape::line};
    for (int i = 0; i <= 180; ++i)
      circle.x.push_back(std::cos(i * pi / 90)), circle.y.push_back(std::sin(i * pi / 90));
    plot.series.push_back(std::move(circle));
  }
  return plot;
}

}  // namespace

report::Page linear_page(const LinearAnalysis& analysis) {
  report::Page page;
  page.title = analysis.title.empty() ? "A linearized diagram" : analysis.title;
  page.subtitle = fmt::format("Linearized at t = {:g} s", analysis.time);
  page.facts = {
      {"Plan", analysis.plan},
      {"Time", analysis.is_sampled() ? fmt::format("sampled, {:g} s", analysis.system.matrices.sample_time)
                                     : "continuous"},
      {"States", fmt::format("{}", analysis.system.matrices.states())}};
  if (analysis.lifted > 1) page.facts.emplace_back("Samples lifted", fmt::format("{}", analysis.lifted));
  if (analysis.loop) page.sections.push_back(loop_section(*analysis.loop));
  if (!analysis.response.empty()) page.sections.push_back(responses(analysis));
  report::Section poles{"Poles and zeros", {pole_table(analysis)}};
  if (!analysis.poles.empty()) poles.items.push_back(pole_plot(analysis));
  if (analysis.zeros && analysis.zeros->empty())
    poles.items.push_back(report::Paragraph{"There are no finite transmission zeros."});
  page.sections.push_back(std::move(poles));
  if (!analysis.notes.empty()) {
    report::Table notes{
        {"Block", "What was done"}, {}, "Where a block is no straight line, this is how it was taken."};
    for (const LinearizationNote& note : analysis.notes) notes.rows.push_back({note.block, note.text});
    page.sections.push_back({"What the linear model leaves out", {std::move(notes)}});
  }
  return page;
}

}  // namespace loopwright
