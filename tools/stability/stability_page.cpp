#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include "tools/report/typography.h"
#include "tools/stability/stability.h"

namespace loopwright {
namespace {

using Severity = report::Notice::Severity;

report::Notice verdict(const StabilityReport& r) {
  if (r.linear_part == Stability::boundary)
    return {Severity::error,
            "The linear part of the loop is at the boundary of stability: no certificate can hold."};
  if (!r.linear_part_is_stable())
    return {Severity::error, "The linear part of the loop is unstable: no certificate can hold."};
  if (r.peak.holds)
    return {Severity::good, "Certified: every signal stays bounded, and a perturbation dies out."};
  return {Severity::warning,
          "Every signal stays bounded as long as the functions do, but the small-gain condition does "
          "not hold: that perturbations die out is not certified."};
}

report::Section summary(const StabilityReport& r) {
  report::KeyNumbers numbers;
  if (!r.learned.empty()) {
    const auto alpha = [](double value) {
      return std::isfinite(value) ? fmt::format("{:.3g}", value) : "any";
    };
    numbers.numbers.push_back({"α of the diagram", fmt::format("{:.3g}", r.alpha), "", ""});
    numbers.numbers.push_back({"Largest certified α", alpha(r.peak.largest_alpha), "", "peak to peak"});
    numbers.numbers.push_back({"Largest certified α", alpha(r.energy.largest_alpha), "", "of energy"});
    const report::Quantity q = report::engineering(r.displacement, r.position_unit);
    numbers.numbers.push_back({"Learned block moves at most", q.value, q.unit, "certificate A"});
  }
  numbers.numbers.push_back({"Ms at the plant", fmt::format("{:.3g}", r.margins.Ms), "",
                             fmt::format("at {:.3g} Hz", r.margins.Ms_frequency / (2 * std::numbers::pi))});
  report::Section section{"Verdict", {verdict(r), std::move(numbers)}};
  for (const std::string& warning : r.warnings)
    section.items.push_back(report::Notice{Severity::warning, warning});
  return section;
}

/// The port under the name in its block.
std::string short_name(const Nonlinearity& n, std::string port) {
  for (const std::string& prefix : {n.block + ".in.", n.block + "."})
    if (port.starts_with(prefix)) return port.substr(prefix.size());
  return port;
}

report::Section certificates(const StabilityReport& r) {
  report::Table functions{{"Function", "Input", "Slope taken", "Deviation at most", "Source"}, {}, ""};
  for (const Nonlinearity& n : r.nonlinearities)
    for (const Nonlinearity::Input& input : n.inputs)
      functions.rows.push_back({n.block, short_name(n, input.port), fmt::format("{:.4g}", input.slope),
                                fmt::format("{:.4g}", input.deviation), n.source});
  functions.caption =
      "The slope taken is in the linear part. Everything else in the loop is linear, delays and holds "
      "included.";
  report::Table table{{"Certificate B", "Spectral radius", "Without learning", "Largest α", "Holds"}, {}, ""};
  const auto add = [&](const char* name, const Certificate& c) {
    table.rows.push_back({name, fmt::format("{:.4g}", c.radius), fmt::format("{:.4g}", c.radius_without),
                          std::isfinite(c.largest_alpha) ? fmt::format("{:.4g}", c.largest_alpha) : "any",
                          c.holds ? "yes" : "no"});
  };
  add("peak to peak (L1)", r.peak), add("energy (H∞)", r.energy);
  table.caption = "A radius below 1 certifies that two responses to the same inputs come together.";
  return {"Certificates",
          {report::Paragraph{
               fmt::format("The linear part, sampled every {:g} s, has its outermost pole at |z| = {:.5f}.",
                           r.sample_time, r.largest_pole)},
           std::move(functions), std::move(table)}};
}

report::Section paper(const PaperCondition& c) {
  report::Table constants{{"Constant", "What it is", "Value"},
                          {},
                          "Gains from peak to peak, of this diagram's own sampled loop."};
  const auto row = [&](const char* name, const char* what, double value) {
    constants.rows.push_back({name, what, fmt::format("{:.4g}", value)});
  };
  row("γ_d→x = c_d", "‖S P‖₁, m/V", c.gamma_dx), row("γ_q", "‖Q Pₙ⁻¹‖₁, V/m", c.gamma_q),
      row("‖Q‖₁", "", c.gain_q);
  row("γ_x→u", "‖C_FB‖₁, V/m", c.gamma_xu), row("γ_ẋ", "‖F_v‖₁, 1/s", c.gamma_v),
      row("γ_g", "‖F_gp‖₁", c.gamma_g);
  row("K", "L_x + L_v γ_ẋ, V/m", c.K), row("c_r", "reference to position, without feedforward", c.gamma_xd);
  row("ρ, eq. 58", "as printed", c.rho_printed),
      row("ρ, eq. 58", "‖Q‖₁ in the place of the second γ_q", c.rho_corrected);
  row("α_max, eq. 62", "as printed", c.alpha_printed),
      row("α_max, eq. 62", "units corrected", c.alpha_corrected);
  row("c₀, eq. 60", "γ_d→x γ_q c_u plus this times b_μ", c.c0_factor);
  const std::string why =
      "The printed (58) adds numbers of different units: the bound of (54) on the observer must have ‖Q‖₁ "
      "where it "
      "repeats γ_q. ";
  report::Notice notice{Severity::good, why + "With that, ρ is below 1."};
  if (c.least_rho > 1)
    notice = {
        Severity::error,
        why +
            fmt::format(
                "Even so the condition cannot hold for this loop, whatever the learned block does: "
                "|S P| at rest is 1/Kp, |C_FB| at rest is Kp, ‖Q‖₁ is at least 1, and Q Pₙ⁻¹ jumps, so ρ is "
                "at least {:.3g} with no learning at all. The proposition is true and empty; the "
                "certificates "
                "above take its place.",
                c.least_rho)};
  else if (c.rho_corrected >= 1)
    notice = {Severity::warning, why + "ρ is not below 1."};
  return {"The paper's condition", {std::move(notice), std::move(constants)}};
}

/// From just before the kick to the time when it should have decayed.
report::Series around_kick(const KickTest& kick) {
  constexpr double before_s = 0.02, after_s = 0.4;
  report::Series series;
  series.name = fmt::format("α = {:.3g}", kick.alpha);
  const auto first =
      std::find_if(kick.difference.begin(), kick.difference.end(), [](double d) { return d != 0; });
  if (first == kick.difference.end()) return series;
  const double start = kick.time[size_t(first - kick.difference.begin())];
  for (size_t i = 0; i < kick.time.size(); ++i)
    if (kick.time[i] >= start - before_s && kick.time[i] <= start + after_s)
      series.x.push_back(kick.time[i]), series.y.push_back(kick.difference[i]);
  return series;
}

report::Section kicks(const StabilityReport& r) {
  report::Table table{{"α", "Largest move", "At the end", "Allowed there", "Dies out"}, {}, ""};
  report::Plot plot;
  plot.title = "Difference that a kick makes";
  plot.x = {"Time", "s", false}, plot.y = {"Position", r.position_unit == "1" ? "" : r.position_unit, false};
  for (const KickTest& kick : r.kicks) {
    table.rows.push_back({fmt::format("{:.4g}", kick.alpha), report::shown(kick.peak, r.position_unit),
                          report::shown(kick.rest, r.position_unit),
                          report::shown(kick.tolerance, r.position_unit), kick.decays ? "yes" : "no"});
    plot.series.push_back(around_kick(kick));
  }
  table.caption = "Two runs each, one with a pulse on the plant's command.";
  return {"Confirmed by simulation", {std::move(table), std::move(plot)}};
}

}  // namespace

report::Page stability_page(const StabilityReport& r) {
  report::Page page;
  page.title = r.title.empty() ? "Stability" : r.title;
  page.subtitle = "Stability of the loop with its learned compensation";
  page.facts = {{"Plan", r.plan}, {"Plant at", r.disturbance}, {"Position at", r.position}};
  if (!r.learned.empty()) page.facts.emplace_back("Learned block", r.learned);
  page.sections = {summary(r), certificates(r)};
  if (r.paper) page.sections.push_back(paper(*r.paper));
  if (!r.kicks.empty()) page.sections.push_back(kicks(r));
  if (!r.notes.empty()) {
    report::Table notes{
        {"Block", "What was done"}, {}, "Blocks that are no straight lines where the run ends."};
    for (const LinearizationNote& note : r.notes) notes.rows.push_back({note.block, note.text});
    page.sections.push_back({"What the linear part leaves out", {std::move(notes)}});
  }
  return page;
}

}  // namespace loopwright
