#include "tools/diagnose/search/leaps_of_input.h"
#include <algorithm>
#include <limits>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/maximum_likelihood.h"
#include "tools/diagnose/search/prepare.h"
#include "tools/diagnose/search/site_start.h"
#include "tools/experiment/false_readings.h"

namespace loopwright::diagnosis {
namespace {

/// -2 ln L of the diagram as it is, with the best noise.
double nominal_misfit(Trials& trials, const Motion& motion) {
  const Estimate nominal = with_own_noise(trials, fit_members(trials, {}, trials.noise, motion, 1), 1);
  return nominal.is_valid ? nominal.profile : std::numeric_limits<double>::infinity();
}
double nominal_misfit(SiteFitter& fitter) {
  SiteHypothesis nominal;
  return start_from_stated(fitter, ErrorsOf::predictions, {}, nominal)
             ? nominal.objective
             : std::numeric_limits<double>::infinity();
}

/// Within one record: where another begins, every signal leaps.
std::vector<size_t> leaps_within_records(const SignalRecord& record, const std::vector<double>& value) {
  std::vector<size_t> rows = leaps_out_and_back(value);
  std::erase_if(rows, [&](size_t row) {
    return record.begins_at(row - 1) || record.begins_at(row) || record.begins_at(row + 1) ||
           record.begins_at(row + 2);
  });
  return rows;
}

}  // namespace

bool does_not_feel_leaps(const std::string& diagram, const std::vector<std::string>& experiments,
                         const LoadOptions& options, Trials& trials, const Motion& motion) {
  const auto leaps = [](const Trial& trial) { return trial.model->record().input_leaps > 0; };
  if (std::ranges::none_of(trials.list, leaps)) return false;
  Motion other_motion;
  Trials without = prepare(diagram, experiments, options, other_motion, InputNoise{.without_leaps = true});
  return nominal_misfit(trials, motion) - nominal_misfit(without, other_motion) >
         criteria::least_gain_of_other_input;
}

size_t take_unfelt_leaps_away(SiteFitter& fitter) {
  SiteModel& model = fitter.model();
  const SignalRecord& record = model.record();
  size_t count = 0;
  double misfit = std::numeric_limits<double>::quiet_NaN();
  for (size_t i = 0; i < record.inputs.size(); ++i) {
    const std::vector<double> recorded = record.inputs[i].value;
    const std::vector<size_t> rows = leaps_within_records(record, recorded);
    if (rows.empty()) continue;
    if (count == 0) misfit = nominal_misfit(fitter);
    std::vector<double> changed = recorded;
    replace_readings(record.time, changed, rows);
    model.suppose_input(i, changed);
    const double without = nominal_misfit(fitter);
    if (misfit - without > criteria::least_gain_of_other_input)
      count += rows.size(), misfit = without;
    else
      model.suppose_input(i, recorded);
  }
  return count;
}

}  // namespace loopwright::diagnosis
