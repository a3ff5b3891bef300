#include "tools/diagnose/verdict/site_inputs.h"
#include <fmt/format.h>
#include <algorithm>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

const char* wording_of(BetweenRows between) {
  switch (between) {
    case BetweenRows::hold:
      return "held";
    case BetweenRows::linear:
      return "on straight lines";
    case BetweenRows::band_limited:
      break;
  }
  return "smooth";
}

/// Of what was found, refined for an input that does this between its rows.
double objective_with(SiteFitter& fitter, SiteHypothesis found, size_t input, BetweenRows between) {
  fitter.model().suppose_between_rows(input, between);
  fitter.refine(found, 4), fitter.fit_noise(found);
  return found.objective;
}

}  // namespace

bool question_inputs(SiteFitter& fitter, const SiteHypothesis& found, std::vector<RecordFinding>& findings) {
  SiteModel& model = fitter.model();
  const bool is_any_found = !found.terms.empty() || found.free_parameters() > 0;
  bool is_any_questioned = false;
  const double needed =
      std::max(criteria::least_gain_of_other_input,
               criteria::least_gain_of_other_input_per_reading * double(model.record().held_out_from));
  for (size_t i = 0; i < model.record().inputs.size(); ++i) {
    const RecordedInput& input = model.record().inputs[i];
    const BetweenRows stated = input.between_rows;
    BetweenRows best = stated;
    const double as_stated = objective_with(fitter, found, i, stated);  // fitted as long as the others
    double gain = 0;
    for (const BetweenRows other : {BetweenRows::hold, BetweenRows::linear, BetweenRows::band_limited}) {
      if (other == stated) continue;
      const double gained = as_stated - objective_with(fitter, found, i, other);
      if (gained > gain) gain = gained, best = other;
    }
    model.suppose_between_rows(i, stated);
    if (!(gain > needed)) continue;
    is_any_questioned = true;
    findings.push_back(
        {fmt::format(
             "with {} {} between its rows it is predicted better than with it {} (-2 ln L falls by {:.0f})",
             input.port, wording_of(best), wording_of(stated), gain),
         fmt::format(
             "{}state \"interpolation\": \"{}\" for it in the experiment, unless the machine is known to "
             "do otherwise{}",
             is_any_found ? "what was found may stand for the difference; first " : "",
             names_of(best)[size_t(best)], is_any_found ? ", and diagnose again" : ""),
         is_any_found, false});
  }
  return is_any_questioned;
}

}  // namespace loopwright::diagnosis
