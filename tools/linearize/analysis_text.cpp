#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include "tools/linearize/analysis.h"

namespace loopwright {
namespace {

using Eigen::Index;
using Complex = std::complex<double>;
using Json = nlohmann::ordered_json;

Json matrix_json(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Index i = 0; i < matrix.rows(); ++i)
    rows.push_back(std::vector<double>(matrix.row(i).begin(), matrix.row(i).end()));
  return rows;
}

Json ports_json(const std::vector<std::string>& names, const std::vector<std::string>& units) {
  Json ports = Json::array();
  for (size_t i = 0; i < names.size(); ++i) ports.push_back({{"name", names[i]}, {"unit", units[i]}});
  return ports;
}

Json pole_json(const Pole& pole, const std::vector<std::string>& states) {
  Json json = {{"re", pole.value.real()},
               {"im", pole.value.imag()},
               {"frequency", pole.frequency},
               {"damping", pole.damping}};
  for (size_t i = 0; i < states.size() && i < pole.participation.size(); ++i)
    if (pole.participation[i] > 0.01)
      json["states"].push_back({{"name", states[i]}, {"share", pole.participation[i]}});
  return json;
}

Json response_json(const std::vector<Complex>& response) {
  Json gain = Json::array();
  for (const Complex& value : response) gain.push_back(std::abs(value));
  return {{"gain", gain}, {"phase_deg", unwrapped_degrees(response)}};
}

/// Numbers that JSON cannot represent are left out.
void put(Json& json, const char* key, double value) {
  if (std::isfinite(value)) json[key] = value;
}

Json loop_json(const LoopAnalysis& loop) {
  const Margins& m = loop.margins;
  Json json = {{"port", loop.port},
               {"is_stable", m.is_stable()},
               {"stability", name_of(m.stability)},
               {"outside", loop.outside}};
  put(json, "gain_margin", m.gain), put(json, "gain_margin_frequency", m.gain_frequency);
  put(json, "lower_gain_margin", m.lower_gain),
      put(json, "lower_gain_margin_frequency", m.lower_gain_frequency);
  put(json, "phase_margin_deg", m.phase * 180 / std::numbers::pi);
  put(json, "phase_margin_frequency", m.phase_frequency);
  put(json, "delay_margin_s", m.delay), put(json, "delay_margin_frequency", m.delay_frequency);
  put(json, "Ms", m.Ms), put(json, "Ms_frequency", m.Ms_frequency);
  json["frequency"] = loop.frequency;
  json.update(response_json(loop.response));
  return json;
}

std::string hertz(double frequency) { return fmt::format("{:.4g} Hz", frequency / (2 * std::numbers::pi)); }

constexpr const char* kind_names[] = {"held", "flat", "staircase", "corner", "inaccurate"};

std::string loop_text(const LoopAnalysis& loop) {
  const Margins& m = loop.margins;
  std::string text = fmt::format("loop cut at {}: {}\n", loop.port,
                                 loop.is_loop() ? fmt::format("closed it is {}", text_of(m.stability))
                                                : "no signal returns to this port, it is in no loop");
  for (const std::string& mode : loop.outside) text += fmt::format("  {}\n", mode);
  const auto line = [&](const char* name, const std::string& value, double frequency) {
    text += fmt::format("  {:<18} {:>12}  at {}\n", name, value, hertz(frequency));
  };
  if (std::isfinite(m.gain))
    line("gain margin", fmt::format("{:.3g} dB", 20 * std::log10(m.gain)), m.gain_frequency);
  if (m.lower_gain > 0)
    line("lower gain margin", fmt::format("{:.3g} dB", 20 * std::log10(m.lower_gain)),
         m.lower_gain_frequency);
  if (std::isfinite(m.phase))
    line("phase margin", fmt::format("{:.2f}°", m.phase * 180 / std::numbers::pi), m.phase_frequency);
  if (std::isfinite(m.delay))
    line("delay margin", fmt::format("{:.4g} ms", 1e3 * m.delay), m.delay_frequency);
  if (std::isfinite(m.Ms)) line("Ms", fmt::format("{:.4g}", m.Ms), m.Ms_frequency);
  return text;
}

}  // namespace

std::string owners(const Pole& pole, const std::vector<std::string>& states) {
  std::vector<size_t> order;
  for (size_t i = 0; i < std::min(states.size(), pole.participation.size()); ++i) order.push_back(i);
  std::ranges::stable_sort(order, std::greater{}, [&](size_t i) { return pole.participation[i]; });
  std::string text;
  for (size_t i = 0; i < order.size() && i < 3 && pole.participation[order[i]] > 0.05; ++i)
    text += fmt::format("{}{} {:.0f} %", i ? ", " : "", states[order[i]], 100 * pole.participation[order[i]]);
  return text;
}

std::string text_of(const Pole& pole, double sample_time, const std::vector<std::string>& states) {
  const std::string who = owners(pole, states);
  return fmt::format("{} = {:.6g}{}{}", sample_time > 0 ? "z" : "s", pole.value.real(),
                     pole.value.imag() != 0 ? fmt::format(" ± {:.6g}j", std::abs(pole.value.imag())) : "",
                     who.empty() ? "" : fmt::format(" ({})", who));
}

std::vector<std::string> texts_of(const std::vector<Modes::Outside>& modes, double sample_time,
                                  const std::vector<std::string>& states) {
  std::vector<std::string> texts;
  for (const Modes::Outside& mode : modes)
    if (mode.pole.value.imag() >= 0)
      texts.push_back(fmt::format("outside this loop and not judged: the mode at {} {}",
                                  text_of(mode.pole, sample_time, states),
                                  mode.stability == Stability::unstable ? "GROWS" : "does not decay"));
  return texts;
}

std::string_view text_of(Stability stability) {
  constexpr std::string_view texts[] = {"stable", "at the boundary of stability", "UNSTABLE"};
  return texts[size_t(stability)];
}

std::string to_json(const LinearAnalysis& analysis) {
  const LinearSystem& system = analysis.system;
  Json json = {{"title", analysis.title},
               {"plan", analysis.plan},
               {"time", analysis.time},
               {"sample_time", system.matrices.sample_time},
               {"lifted", analysis.lifted},
               {"states", system.states},
               {"inputs", ports_json(system.inputs, system.input_units)},
               {"outputs", ports_json(system.outputs, system.output_units)},
               {"A", matrix_json(system.matrices.A)},
               {"B", matrix_json(system.matrices.B)},
               {"C", matrix_json(system.matrices.C)},
               {"D", matrix_json(system.matrices.D)},
               {"delays", system.matrices.delays}};
  json["poles"] = Json::array();
  for (const Pole& pole : analysis.poles) json["poles"].push_back(pole_json(pole, system.states));
  if (analysis.zeros) {
    json["zeros"] = Json::array();
    for (const Complex& zero : *analysis.zeros)
      json["zeros"].push_back({{"re", zero.real()}, {"im", zero.imag()}});
  }
  if (!analysis.response.empty()) {
    json["response"]["frequency"] = analysis.frequency;
    for (size_t i = 0; i < system.inputs.size(); ++i)
      for (size_t o = 0; o < system.outputs.size(); ++o) {
        Json channel = {{"from", system.inputs[i]}, {"to", system.outputs[o]}};
        channel.update(response_json(channel_response(analysis, Index(i), Index(o))));
        json["response"]["channels"].push_back(channel);
      }
  }
  if (analysis.loop) json["loop"] = loop_json(*analysis.loop);
  for (const MeasuredPoint& point : analysis.measured)
    json["measured"].push_back({{"frequency", point.frequency},
                                {"gain", std::abs(point.response)},
                                {"phase_deg", std::arg(point.response) * 180 / std::numbers::pi}});
  if (analysis.sines > 0) json["sines"] = analysis.sines;
  json["notes"] = Json::array();
  for (const LinearizationNote& note : analysis.notes)
    json["notes"].push_back(
        {{"kind", kind_names[int(note.kind)]}, {"block", note.block}, {"text", note.text}});
  return json.dump(1) + "\n";
}

Recording to_recording(const LinearAnalysis& analysis) {
  Recording recording;
  recording.facts = {{"title", analysis.title}, {"plan", analysis.plan}};
  recording.columns.push_back({"frequency", "rad/s", analysis.frequency});
  const LinearSystem& system = analysis.system;
  for (size_t i = 0; i < system.inputs.size(); ++i)
    for (size_t o = 0; o < system.outputs.size(); ++o) {
      const std::vector<Complex> response = channel_response(analysis, Index(i), Index(o));
      const std::string name = fmt::format("{} to {}", system.inputs[i], system.outputs[o]);
      Column gain{name + " gain", "", {}};
      for (const Complex& value : response) gain.values.push_back(std::abs(value));
      recording.columns.push_back(std::move(gain));
      recording.columns.push_back({name + " phase", "degree", unwrapped_degrees(response)});
    }
  return recording;
}

std::string to_text(const LinearAnalysis& analysis) {
  std::string text = fmt::format(
      "linearized at t = {:g} s, {}\n", analysis.time,
      analysis.is_sampled()
          ? fmt::format("sampled every {:g} s{}", analysis.system.matrices.sample_time,
                        analysis.lifted > 1 ? fmt::format(", {} samples lifted", analysis.lifted) : "")
          : "continuous");
  text += fmt::format("  {:>24} {:>12} {:>9}  states\n",
                      analysis.is_sampled() ? "pole in z" : "pole in s (1/s)", "frequency", "damping");
  for (const Pole& pole : analysis.poles)
    if (pole.value.imag() >= 0)
      text += fmt::format("  {:>24} {:>12} {:>9.4f}  {}\n",
                          pole.value.imag() > 0
                              ? fmt::format("{:.6g} ± {:.6g}j", pole.value.real(), pole.value.imag())
                              : fmt::format("{:.6g}", pole.value.real()),
                          std::isfinite(pole.frequency) ? hertz(pole.frequency) : "-", pole.damping,
                          owners(pole, analysis.system.states));
  if (analysis.zeros) {
    text += "transmission zeros:";
    for (const Complex& zero : *analysis.zeros)
      if (zero.imag() >= 0)
        text += zero.imag() > 0 ? fmt::format(" {:.6g} ± {:.6g}j", zero.real(), zero.imag())
                                : fmt::format(" {:.6g}", zero.real());
    text += analysis.zeros->empty() ? " none\n" : "\n";
  }
  if (analysis.loop) text += loop_text(*analysis.loop);
  if (analysis.measured.size() < analysis.sines)
    text +=
        fmt::format("interrupted: {} of {} sines were measured\n", analysis.measured.size(), analysis.sines);
  for (const LinearizationNote& note : analysis.notes)
    text += fmt::format("note: {}: {}\n", note.block, note.text);
  return text;
}

}  // namespace loopwright
