#include <fmt/format.h>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include "tools/design/design.h"
#include "tools/design/design_json.h"
#include "tools/linearize/analysis.h"

namespace loopwright {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Json = nlohmann::ordered_json;

Json signals_json(const std::vector<DesignSignal>& signals) {
  Json list = Json::array();
  for (const DesignSignal& signal : signals)
    list.push_back({{"name", signal.name}, {"unit", unit_text(signal.unit)}});
  return list;
}

std::vector<std::string> names_of(const std::vector<DesignSignal>& signals) {
  std::vector<std::string> names;
  for (const DesignSignal& signal : signals) names.push_back(signal.name);
  return names;
}

/// A gain for each state and each signal on the other side.
std::string gains_text(const Design& design) {
  const bool is_filter = design.kind == DesignKind::filter;
  const auto& others = is_filter ? design.outputs : design.inputs;
  const MatrixXd gains = is_filter ? design.filter.gain : MatrixXd(design.regulator.K.transpose());
  std::string text;
  for (size_t o = 0; o < others.size(); ++o) {
    text += is_filter ? fmt::format("correction by {}, for each unit of the innovation\n", others[o].name)
                      : fmt::format("{} = - the sum of gain · state\n", others[o].name);
    for (size_t i = 0; i < design.states.size(); ++i) {
      const auto& [of, per] = is_filter ? std::pair{design.states[i].unit, others[o].unit}
                                        : std::pair{others[o].unit, design.states[i].unit};
      std::string unit;
      if (of && per) unit = to_string(*of * power(*per, -1));
      if (is_filter && !design.is_sampled() && of && per)
        unit = to_string(*of * power(*per, -1) * power(Unit{1.0, {0, 0, 1}}, -1));
      text += fmt::format("  {:>16.9g} {:<12} {}\n", gains(Index(i), Index(o)), unit, design.states[i].name);
    }
  }
  return text;
}

std::string poles_text(const Design& design) {
  std::string text =
      fmt::format("  {:>26} {:>12} {:>9}  states\n",
                  fmt::format("{} pole in {}", design.kind == DesignKind::filter ? "error" : "closed-loop",
                              design.is_sampled() ? "z" : "s"),
                  "frequency", "damping");
  for (const Pole& pole : design.poles()) {
    if (pole.value.imag() < 0) continue;
    const std::string value = pole.value.imag() > 0
                                  ? fmt::format("{:.6g} ± {:.6g}j", pole.value.real(), pole.value.imag())
                                  : fmt::format("{:.6g}", pole.value.real());
    const std::string frequency = std::isfinite(pole.frequency)
                                      ? fmt::format("{:.4g} Hz", pole.frequency / (2 * std::numbers::pi))
                                      : "-";
    text += fmt::format("  {:>26} {:>12} {:>9.4f}  {}\n", value, frequency, pole.damping,
                        owners(pole, names_of(design.states)));
  }
  return text;
}

}  // namespace

std::string to_text(const Design& design) {
  const bool is_filter = design.kind == DesignKind::filter;
  std::string text = fmt::format(
      "{} for the linearization at t = {:g} s, {}\n", is_filter ? "Kalman filter" : "state feedback",
      design.time,
      design.is_sampled() ? fmt::format("sampled every {:g} s", design.system.sample_time) : "continuous");
  text += gains_text(design) + poles_text(design);
  if (is_filter)
    for (size_t i = 0; i < design.states.size(); ++i)
      text += fmt::format("standard deviation of {}{}: {:.4g} {}\n", design.states[i].name,
                          design.is_sampled() ? " before its correction" : "",
                          std::sqrt(std::max(0.0, design.filter.P(Index(i), Index(i)))),
                          unit_text(design.states[i].unit));
  text += fmt::format("residual of the Riccati equation: {:.1e} of its largest term\n",
                      is_filter ? design.filter.residual : design.regulator.residual);
  for (const std::string& state : design.left_out)
    text += fmt::format("not in the design: {}, as nothing {} depends on it\n", state,
                        is_filter ? "measured" : "weighted");
  for (const LinearizationNote& note : design.notes)
    text += fmt::format("note: {}: {}\n", note.block, note.text);
  return text;
}

std::string to_json(const Design& design) {
  const bool is_filter = design.kind == DesignKind::filter;
  Json json = {{"kind", is_filter ? "kalman" : "lqr"},
               {"title", design.title},
               {"plan", design.plan},
               {"time", design.time},
               {"sample_time", design.system.sample_time},
               {"states", signals_json(design.states)},
               {"inputs", signals_json(design.inputs)},
               {"outputs", signals_json(design.outputs)},
               {"A", matrix_json(design.system.A)},
               {"B", matrix_json(design.system.B)},
               {"C", matrix_json(design.system.C)},
               {"D", matrix_json(design.system.D)},
               {"Q", matrix_json(design.cost.Q)},
               {"R", matrix_json(design.cost.R)},
               {"N", matrix_json(design.cost.N)}};
  if (is_filter) {
    json["gain"] = matrix_json(design.filter.gain);
    if (design.is_sampled()) json["predictor"] = matrix_json(design.filter.predictor);
    json["P"] = matrix_json(design.filter.P);
  } else {
    json["K"] = matrix_json(design.regulator.K), json["X"] = matrix_json(design.regulator.X);
  }
  json["residual"] = is_filter ? design.filter.residual : design.regulator.residual;
  json["poles"] = Json::array();
  for (const Pole& pole : design.poles())
    json["poles"].push_back({{"re", pole.value.real()}, {"im", pole.value.imag()}});
  json["left_out"] = design.left_out;
  json["notes"] = Json::array();
  for (const LinearizationNote& note : design.notes)
    json["notes"].push_back({{"block", note.block}, {"text", note.text}});
  return json.dump(1) + "\n";
}

}  // namespace loopwright
