/// Linear analysis between two ports, with its loops closed or with one of them cut.
#include <algorithm>
#include <cmath>
#include <numbers>
#include "engine/diagram/in_memory.h"
#include "tools/linearize/analysis.h"
#include "tools/linearize/nyquist.h"
#include "tools/studio/session/session.h"

namespace loopwright::studio {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

Json poles_json(const LinearAnalysis& analysis) {
  const double fastest = fastest_of(analysis.poles);
  Json list = Json::array();
  for (const Pole& pole : analysis.poles)
    list.push_back(
        {{"re", pole.value.real()},
         {"im", pole.value.imag()},
         {"frequency", pole.frequency / (2 * std::numbers::pi)},
         {"damping", pole.damping},
         {"stability", name_of(stability_of(pole, analysis.system.matrices.sample_time, fastest))}});
  return list;
}

/// Margins that nothing limits are null.
Json margins_json(const LoopAnalysis& loop) {
  const Margins& m = loop.margins;
  const auto decibels = [](double factor) { return 20 * std::log10(factor); };
  return {{"port", loop.port},
          {"stable", m.is_stable()},
          {"gain_db", decibels(m.gain)},
          {"lower_gain_db", m.lower_gain > 0 ? Json(decibels(m.lower_gain)) : Json(nullptr)},
          {"phase_deg", m.phase * degrees},
          {"crossover", std::isfinite(m.phase) ? Json(m.phase_frequency) : Json(nullptr)},
          {"delay", m.delay},
          {"Ms", m.Ms}};
}

/// Of a loop gain near -1, with the circle that it touches; of another response all of it.
Json nyquist_json(const LoopAnalysis* loop, const std::vector<std::complex<double>>& response) {
  if (loop) {
    const NyquistCurves curves = nyquist_curves(*loop);
    return {{"re", curves.real},
            {"im", curves.imaginary},
            {"circle", {{"re", curves.circle_real}, {"im", curves.circle_imaginary}}}};
  }
  Json json{{"re", Json::array()}, {"im", Json::array()}, {"circle", nullptr}};
  for (const std::complex<double>& value : response)
    json["re"].push_back(value.real()), json["im"].push_back(value.imag());
  return json;
}

}  // namespace

Json Session::linearize(const Request& request) {
  const auto file = source(request.required("path"));
  const LoadOptions options = request.options();
  LinearizeRequest wanted;
  const std::string from = request.required("from"), to = request.required("to"), cut = request.text("break");
  wanted.access.from = {from}, wanted.access.to = {to};
  wanted.break_point = cut;
  if (!cut.empty()) wanted.access.open = {cut};
  return start(request, [=](Work& work) -> Json {
    Problems problems;
    const auto diagram = load_diagram_text(file, options, problems);
    const auto plan = diagram ? compile(*diagram, problems) : nullptr;
    if (!plan) throw InputError(std::move(problems));
    RunOptions run_options;
    run_options.interrupt = &work.job.interrupt();
    const LinearAnalysis analysis = analyse(*plan, wanted, run_options);
    // From the cut once around to the cut: that is the loop gain, with the sign of negative feedback.
    const bool is_loop_gain = analysis.loop && from == cut && to == cut;
    const std::vector<std::complex<double>> response =
        is_loop_gain ? analysis.loop->response : channel_response(analysis, 0, 0);
    Json json{{"is_loop_gain", is_loop_gain},
              {"sampled", analysis.is_sampled()},
              {"sample_time", analysis.system.matrices.sample_time},
              {"frequency", is_loop_gain ? analysis.loop->frequency : analysis.frequency},
              {"magnitude_db", Json::array()},
              {"phase_deg", unwrapped_degrees(response)},
              {"nyquist", nyquist_json(is_loop_gain ? &*analysis.loop : nullptr, response)},
              {"poles", poles_json(analysis)},
              {"zeros", Json::array()},
              {"margins", analysis.loop ? margins_json(*analysis.loop) : Json(nullptr)},
              {"text", to_text(analysis)}};
    for (const std::complex<double>& value : response)
      json["magnitude_db"].push_back(20 * std::log10(std::abs(value)));
    if (analysis.zeros)
      for (const std::complex<double>& zero : *analysis.zeros)
        json["zeros"].push_back({zero.real(), zero.imag()});
    return json;
  });
}

}  // namespace loopwright::studio
