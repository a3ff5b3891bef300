#include <fmt/format.h>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include "tools/linearize/analysis.h"
#include "tools/report/typography.h"
#include "tools/stability/stability.h"

namespace loopwright {
namespace {

using Json = nlohmann::ordered_json;

std::string alpha_text(double alpha) { return std::isfinite(alpha) ? fmt::format("{:.4g}", alpha) : "any"; }

std::string certificate_text(const char* name, const Certificate& c, bool has_learned) {
  std::string text = fmt::format("  B, {}: spectral radius {:.4g}, {}", name, c.radius,
                                 c.holds ? "below 1: certified" : "NOT certified");
  if (has_learned) text += fmt::format("; largest certified alpha {}", alpha_text(c.largest_alpha));
  return text + "\n";
}

Json certificate_json(const Certificate& c) {
  Json json = {{"holds", c.holds}};
  if (std::isfinite(c.radius)) json["radius"] = c.radius;
  json["radius_without_learning"] = c.radius_without;
  if (std::isfinite(c.largest_alpha)) json["largest_alpha"] = c.largest_alpha;
  return json;
}

Json paper_json(const PaperCondition& c) {
  return {{"gamma_dx", c.gamma_dx},
          {"gamma_q", c.gamma_q},
          {"gain_q", c.gain_q},
          {"gamma_v", c.gamma_v},
          {"gamma_xu", c.gamma_xu},
          {"gamma_g", c.gamma_g},
          {"gamma_xd", c.gamma_xd},
          {"K", c.K},
          {"rho_printed", c.rho_printed},
          {"rho_corrected", c.rho_corrected},
          {"least_rho", c.least_rho},
          {"alpha_max_printed", c.alpha_printed},
          {"alpha_max_corrected", c.alpha_corrected},
          {"c_d", c.gamma_dx},
          {"c_r", c.gamma_xd},
          {"c0_factor", c.c0_factor},
          {"holds", c.rho_corrected < 1}};
}

}  // namespace

std::string to_json(const StabilityReport& r) {
  Json json = {{"title", r.title},
               {"plan", r.plan},
               {"certified", r.is_certified()},
               {"alpha", r.alpha},
               {"lead_s", r.lead},
               {"sample_time", r.sample_time},
               {"disturbance", r.disturbance},
               {"position", r.position},
               {"learned", r.learned},
               {"linear_part",
                {{"is_stable", r.linear_part_is_stable()},
                 {"stability", name_of(r.linear_part)},
                 {"largest_pole", r.largest_pole}}},
               {"margins", {{"is_stable", r.margins.is_stable()}, {"Ms", r.margins.Ms}}}};
  const auto put = [&](const char* key, double value) {
    if (std::isfinite(value)) json["margins"][key] = value;
  };
  put("gain_margin", r.margins.gain), put("phase_margin_deg", r.margins.phase * 180 / std::numbers::pi);
  put("delay_margin_s", r.margins.delay);
  json["A"] = {
      {"holds", r.linear_part_is_stable()}, {"displacement", r.displacement}, {"unit", r.position_unit}};
  json["B"] = {{"peak", certificate_json(r.peak)}, {"energy", certificate_json(r.energy)}};
  if (r.paper) json["paper"] = paper_json(*r.paper);
  json["nonlinearities"] = Json::array();
  for (const Nonlinearity& n : r.nonlinearities) {
    Json entry = {{"block", n.block}, {"learned", n.is_learned}, {"jumps", n.has_jumps}, {"bound", n.bound}};
    for (const Nonlinearity::Input& input : n.inputs)
      entry["inputs"].push_back(
          {{"port", input.port}, {"slope", input.slope}, {"deviation", input.deviation}});
    json["nonlinearities"].push_back(entry);
  }
  json["kicks"] = Json::array();
  for (const KickTest& kick : r.kicks)
    json["kicks"].push_back({{"alpha", kick.alpha},
                             {"peak", kick.peak},
                             {"rest", kick.rest},
                             {"tolerance", kick.tolerance},
                             {"decays", kick.decays}});
  json["warnings"] = r.warnings;
  return json.dump(1) + "\n";
}

std::string to_text(const StabilityReport& r) {
  const bool has_learned = !r.learned.empty();
  std::string text =
      fmt::format("plant at {}, position at {}{}\n", r.disturbance, r.position,
                  has_learned ? fmt::format(", learned block {} with alpha {:.4g}", r.learned, r.alpha) : "");
  text += fmt::format("linear part, sampled every {:g} s: {}, largest |z| {:.6g}; at the plant Ms {:.3g}\n",
                      r.sample_time, text_of(r.linear_part), r.largest_pole, r.margins.Ms);
  for (const Nonlinearity& n : r.nonlinearities)
    for (const Nonlinearity::Input& input : n.inputs)
      text += fmt::format("  {}: slope within {:.4g} ± {:.4g} by {}\n", n.block, input.slope, input.deviation,
                          input.port);
  text += fmt::format("certificates\n  A: {}\n",
                      !r.linear_part_is_stable() ? "does not hold, the linear part is not stable"
                      : has_learned
                          ? "bounded for every alpha; the learned block moves the position by at most " +
                                report::shown(r.displacement, r.position_unit)
                          : "bounded, the linear part is stable");
  text += certificate_text("peak to peak", r.peak, has_learned) +
          certificate_text("energy", r.energy, has_learned);
  if (r.paper) {
    const PaperCondition& c = *r.paper;
    text += fmt::format(
        "the paper's condition\n  gamma_dx {:.4g}, gamma_q {:.4g}, |Q| {:.4g}, gamma_xu {:.4g}, gamma_v "
        "{:.4g}, "
        "gamma_g {:.4g}, K {:.4g}\n  rho {:.4g} as printed, {:.4g} with units corrected: {}\n",
        c.gamma_dx, c.gamma_q, c.gain_q, c.gamma_xu, c.gamma_v, c.gamma_g, c.K, c.rho_printed,
        c.rho_corrected,
        c.least_rho > 1
            ? fmt::format(
                  "not below 1, and no tuning of alpha helps: rho is at least {:.3g} without any learning",
                  c.least_rho)
        : c.rho_corrected < 1 ? "below 1"
                              : "not below 1");
  }
  for (const KickTest& kick : r.kicks)
    text += fmt::format("kick at alpha {:.4g}: moves {}, at the end {}: {}\n", kick.alpha,
                        report::shown(kick.peak, r.position_unit), report::shown(kick.rest, r.position_unit),
                        kick.decays ? "dies out" : "DOES NOT DIE OUT");
  for (const std::string& warning : r.warnings) text += "warning: " + warning + "\n";
  return text;
}

}  // namespace loopwright
