#include "tools/diagnose/verdict/site_additions.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "engine/json/reader.h"
#include "tools/diagnose/verdict/site_units.h"
#include "tools/diagnose/wording.h"
#include "tools/effects/json_text.h"

namespace loopwright::diagnosis {
namespace {

/// [K] The temperature at which the coefficient of radiation is stated.
constexpr double reference_temperature = 300;

std::string quantity(double value, const std::string& unit) {
  if (unit.empty() || unit == "1") return readable_number(value);
  return fmt::format(R"({{"value": {}, "unit": "{}"}})", readable_number(value), unit);
}

class Writer {
 public:
  Writer(const SiteModel& model, const SiteTerm& term)
      : model_(model), term_(term), shape_(*term.shape), site_(model.sites()[size_t(term.site)]) {}

  AddedEffect added() const {
    AddedEffect added{std::string(shape_.name), {}, {}, {}, Term{}};
    Term& term = *added.term;
    const std::vector<std::string> path = split_path(site_.name);
    term.name = fmt::format("{}_at_{}", shape_.name, path[path.size() < 2 ? 0 : path.size() - 2]);
    term.title = shape_.title, term.port = site_.name;
    if (term_.variable >= 0) {
      const SiteVariable& variable = model_.variables()[size_t(term_.variable)];
      term.reads = {variable.name};
      if (variable.minus >= 0) term.reads = split(variable.name, " - ");
    }
    term.input = "u";
    if (shape_.of == TermShape::Of::past)
      add_late_input(term);
    else if (shape_.remembered)
      add_friction_with_memory(term);
    else if (shape_.of == TermShape::Of::nothing)
      term.settings =
          fmt::format(R"("type": "Constant", "value": {})", quantity(coefficient(0), unit_of_site()));
    else if (is_unknown_function(shape_))
      term.settings = table(), added.note = range_of_table();
    else if (shape_.formula.empty())
      term.settings = fmt::format(R"("type": "Gain", "gain": {})",
                                  quantity(coefficient(0), unit_of_coefficient(model_, term_)));
    else
      term.settings = expression(), term.input = "arguments[]";
    return added;
  }

 private:
  double coefficient(size_t i) const { return term_.coefficient[i]; }
  std::string unit_of_site() const { return unit_text(site_.unit); }
  std::string unit_of_signal() const { return unit_text(model_.variables()[size_t(term_.variable)].unit); }

  /// The block of the delay or lag, beside what it reads.
  void add_late_input(Term& term) const {
    const bool is_delay = shape_.name == "delay";
    const RecordedInput& input = model_.record().inputs[size_t(model_.input_of(term_.site))];
    term.reads = {input.port}, term.is_change = true;
    term.settings = fmt::format(
        R"("type": "{}", "{}": {}, "initial": {})", is_delay ? "TransportDelay" : "ActuatorLag",
        shape_.nonlinear[0], quantity(term_.nonlinear[0], "s"), quantity(term_.nonlinear[1], unit_of_site()));
    if (!is_delay) term.input = "command", term.output = "force";
  }

  /// Its block states a resistance.
  void add_friction_with_memory(Term& term) const {
    term.is_subtracted = coefficient(0) < 0;
    term.settings = fmt::format(R"("type": "DahlFriction", "level": {}, "transition_distance": {})",
                                quantity(std::abs(coefficient(0)), unit_of_site()),
                                quantity(term_.nonlinear[0], unit_of_own_parameter(model_, term_, 0)));
    term.input = "velocity", term.output = "force";
  }

  static std::vector<std::string> split(const std::string& name, std::string_view by) {
    const size_t at = name.find(by);
    return {name.substr(0, at), name.substr(at + by.size())};
  }

  std::string expression() const {
    std::string constants;
    const auto add = [&](std::string_view name, double value, const std::string& unit) {
      constants +=
          fmt::format(R"({}{{"name": "{}", "value": {}{}}})", constants.empty() ? "" : ", ", name,
                      readable_number(value), unit.empty() ? "" : fmt::format(R"(, "unit": "{}")", unit));
    };
    if (shape_.has_coefficients())
      for (int c = 0; c < shape_.columns; ++c)
        add(shape_.coefficients[size_t(c)], coefficient(size_t(c)), unit_of_coefficient(model_, term_));
    for (int p = 0; p < shape_.nonlinear_count(); ++p)
      add(shape_.nonlinear[size_t(p)], term_.nonlinear[size_t(p)], unit_of_signal());
    if (shape_.name == "radiation") add("reference", reference_temperature, unit_of_signal());
    return fmt::format(R"("type": "Expression", "formula": "{}", "names": ["signal"], "constants": [{}])",
                       shape_.formula, constants);
  }

  std::string table() const {
    std::string at, value;
    for (int i = 0; i < shape_.columns; ++i) {
      const double part = double(i) / (shape_.columns - 1);
      at += (i ? ", " : "") +
            readable_number(term_.nonlinear[0] + part * (term_.nonlinear[1] - term_.nonlinear[0]));
      value += (i ? ", " : "") + readable_number(coefficient(size_t(i)));
    }
    return fmt::format(
        R"("type": "Lookup1D", "description": "No shape of the catalogue fits. Beyond the record its ends are held.", "breakpoints": [{}], "values": [{}], "interpolation": "linear", "outside": "hold")",
        at, value);
  }
  std::string range_of_table() const {
    return fmt::format(
        "The unknown function of {} at {} is a lookup from {} to {}; beyond them its ends are held.",
        model_.variables()[size_t(term_.variable)].name, site_.name,
        shown(term_.nonlinear[0], unit_of_signal()), shown(term_.nonlinear[1], unit_of_signal()));
  }

  const SiteModel& model_;
  const SiteTerm& term_;
  const TermShape& shape_;
  const Site& site_;
};

}  // namespace

Additions site_additions(const SiteModel& model, const SiteHypothesis& found,
                         const std::vector<bool>& leave_out) {
  Additions additions;
  for (size_t t = 0; t < found.terms.size(); ++t) {
    const Site& site = model.sites()[size_t(found.terms[t].site)];
    if (leave_out[t]) continue;
    if (site.kind == Site::Kind::sensor)
      additions.not_stated.push_back(
          fmt::format("The error of what is measured at {} ({}) is not written into the diagram.",
                      site.own_signal, found.terms[t].shape->name));
    else
      additions.effects.push_back(Writer(model, found.terms[t]).added());
  }
  for (size_t i = 0; i < found.is_free.size(); ++i)
    if (found.is_free[i])
      additions.parameters.emplace_back(model.parameters()[i].name,
                                        model.parameters()[i].nominal * found.factors[i]);
  return additions;
}

}  // namespace loopwright::diagnosis
