/// Units of what is found at a site, in SI.
#pragma once
#include "tools/diagnose/predict/site_model.h"

namespace loopwright::diagnosis {

inline std::string unit_text(const std::optional<Unit>& unit) { return unit ? to_string(unit->in_si()) : ""; }

/// Of a parameter of a shape that is no coefficient: that of its signal, of what this integrates to, or of a
/// time.
inline std::string unit_of_own_parameter(const SiteModel& model, const SiteTerm& term, size_t index) {
  if (term.shape->of == TermShape::Of::past)
    return index == 0 ? "s" : unit_text(model.sites()[size_t(term.site)].unit);
  if (term.variable < 0) return "";
  const std::optional<Unit>& of_signal = model.variables()[size_t(term.variable)].unit;
  if (!term.shape->remembered || !of_signal) return unit_text(of_signal);
  return to_string(of_signal->in_si() * *parse_unit("s"));
}

/// Empty where the site or the variable has no unit.
inline std::string unit_of_coefficient(const SiteModel& model, const SiteTerm& term) {
  const Site& site = model.sites()[size_t(term.site)];
  if (term.variable < 0 || term.shape->power == 0) return unit_text(site.unit);
  const std::optional<Unit>& of_signal = model.variables()[size_t(term.variable)].unit;
  if (!site.unit || !of_signal) return "";
  return to_string(site.unit->in_si() * power(of_signal->in_si(), -term.shape->power));
}

}  // namespace loopwright::diagnosis
