#include "tools/diagnose/diagnosis_plots.h"
#include <fmt/format.h>
#include <cctype>
#include "tools/diagnose/wording.h"

namespace loopwright {
namespace {

std::string lower(std::string name) {
  for (char& c : name) c = char(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

}  // namespace

report::Section terms_at_their_sites(const Diagnosis& d) {
  report::Section section{"Each missing term at its site", {}};
  section.items.push_back(report::Paragraph{
      d.has_roles
          ? "Points: the force that the diagram lacks with all other effects in it. Line: the force of the "
            "named effect, means over narrow ranges of the variable that determines most of it."
          : "Points: what the diagram lacks at the site with everything else in it, as a function without a "
            "name, of straight lines between these points, that was fitted in the place of the effect. Line: "
            "the effect as it was found."});
  for (const MissingTerm& term : d.terms) {
    report::Plot plot;
    plot.title = fmt::format("{} at {}, over {}", words(term.effect), term.site,
                             d.has_roles ? lower(term.variable) : term.variable);
    plot.x = {term.variable, term.unit};
    plot.y = {d.has_roles ? "Missing force" : "Missing term", term.site_unit};
    plot.series.push_back({"left by all others", term.at, term.found, report::Series::Shape::points});
    plot.series.push_back({words(term.effect), term.shape_at, term.shape});
    section.items.push_back(std::move(plot));
  }
  return section;
}

report::Section improved_diagram(const Diagnosis& d) {
  report::Section section{"The improved diagram", {}};
  section.items.push_back(report::Paragraph{
      d.improved.empty() ? "Blocks with a thick outline would be added; -o FILE writes this diagram."
                         : "Blocks with a thick outline were added."});
  section.items.push_back(d.picture);
  return section;
}

report::Plot steps_of_the_error(const Diagnosis& d) {
  report::Plot plot;
  const bool held_out = d.holds_out, is_simulated = d.is_simulated() || !d.has_roles;
  plot.title = is_simulated ? "Error of the simulation" : "Residual force";
  if (held_out) plot.title += ", held-out rows";
  if (d.is_simulated()) plot.title += fmt::format(", {:.3g} s ahead", d.simulation_horizon_s);
  plot.x = {.label = "Row of the table below", .unit = "", .counts = true};
  plot.y = {is_simulated ? "Simulation error" : "Residual force",
            is_simulated ? d.measured_unit : d.force_unit};
  report::Series series{"the diagram so far", {}, {}, report::Series::Shape::steps};
  for (const DiagnosisStep& step : d.steps) {
    series.x.push_back(double(series.x.size() + 1));
    series.y.push_back(is_simulated ? step.simulation_rmse
                       : held_out   ? step.held_out_force_rmse
                                    : step.force_rmse);
  }
  series.x.push_back(double(series.x.size() + 1)), series.y.push_back(series.y.back());
  plot.series.push_back(std::move(series));
  return plot;
}

report::Plot whiteness(const Diagnosis& d) {
  report::Plot plot;
  plot.title =
      "Whiteness of the prediction errors" + (d.whiteness.port.empty() ? "" : " of " + d.whiteness.port);
  plot.x = {"Distance in time", "s"}, plot.y = {"Correlation", ""};
  plot.series.push_back({"nominal diagram", d.whiteness.lag_s, d.whiteness.before});
  if (!d.effects.empty() || !d.moved_parameters.empty())
    plot.series.push_back({"with what was found", d.whiteness.lag_s, d.whiteness.after});
  for (const double side : {-1.0, 1.0})
    plot.marks.push_back({report::Mark::Along::y, side * d.whiteness.most, ""});
  plot.caption =
      "Between the lines are 95 % of the correlations of errors that are white: nothing in them can be "
      "predicted.";
  return plot;
}

}  // namespace loopwright
