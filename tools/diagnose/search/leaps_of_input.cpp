#include "tools/diagnose/search/leaps_of_input.h"
#include <algorithm>
#include <limits>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/prepare.h"
#include "tools/diagnose/search/site_start.h"
#include "tools/experiment/false_readings.h"

namespace loopwright::diagnosis {
namespace {

constexpr double impossible = std::numeric_limits<double>::infinity();
constexpr InputLeaps unfelt[] = {InputLeaps::far_unfelt, InputLeaps::unfelt};

/// -2 ln L of the diagram as it is, over rows that count in both trials.
double misfit(Trials& trials, const Trials& other) {
  std::vector<std::vector<char>> usable;
  for (size_t t = 0; t < trials.list.size(); ++t) {
    std::vector<char>& own = trials.list[t].usable;
    usable.push_back(own);
    for (size_t k = 0; k < own.size(); ++k) own[k] = own[k] && other.list[t].usable[k];
  }
  const double value = profile(trials, run_members(trials, {}, {}, trials.noise));
  for (size_t t = 0; t < trials.list.size(); ++t) trials.list[t].usable = usable[t];
  return std::isfinite(value) ? value : impossible;
}
/// The steps within a sample that a wrong value asks for are not those of the record.
double misfit(SiteFitter& fitter) {
  SiteHypothesis nominal;
  const int substeps = fitter.model().substeps();
  const bool is_found = start_from_stated(fitter, ErrorsOf::predictions, {}, nominal).has_value();
  fitter.model().set_substeps(substeps), fitter.filter().guess_scales(1);
  return is_found ? nominal.objective : impossible;
}

/// Within one record: where another begins, every signal leaps.
std::vector<size_t> rows_within_records(const SignalRecord& record, const std::vector<double>& value,
                                        InputLeaps leaps) {
  std::vector<size_t> rows = unfelt_rows(value, leaps);
  std::erase_if(rows, [&](size_t row) {
    return record.begins_at(row - 1) || record.begins_at(row) || record.begins_at(row + 1) ||
           record.begins_at(row + 2);
  });
  return rows;
}

}  // namespace

size_t input_leaps(const Trials& trials) {
  size_t count = 0;
  for (const Trial& trial : trials.list) count += trial.model->record().input_leaps;
  return count;
}

std::optional<InputLeaps> unfelt_leaps(const std::string& diagram,
                                       const std::vector<std::string>& experiments,
                                       const LoadOptions& options, Trials& trials) {
  std::optional<InputLeaps> best;
  double most = criteria::least_gain_of_other_input;
  for (const InputLeaps leaps : unfelt) {
    if (input_leaps(trials) == 0) break;
    Motion motion;
    Trials without = prepare(diagram, experiments, options, motion, InputCorrection{.leaps = leaps});
    if (input_leaps(without) == 0) continue;
    const double gain = misfit(trials, without) - misfit(without, trials);
    if (!(gain > most)) continue;
    best = leaps, most = gain + criteria::least_gain_of_other_input;
  }
  return best;
}

size_t take_unfelt_leaps_away(SiteFitter& fitter) {
  SiteModel& model = fitter.model();
  const SignalRecord& record = model.record();
  size_t count = 0;
  std::optional<double> least;
  for (size_t i = 0; i < record.inputs.size(); ++i) {
    const std::vector<double> recorded = record.inputs[i].value;
    std::vector<double> best = recorded;
    size_t taken = 0;
    for (const InputLeaps leaps : unfelt) {
      const std::vector<size_t> rows = rows_within_records(record, recorded, leaps);
      if (rows.empty()) continue;
      if (!least) least = misfit(fitter);
      std::vector<double> changed = recorded;
      replace_readings(record.time, changed, rows);
      model.suppose_input(i, changed);
      const double without = misfit(fitter);
      if (*least - without > criteria::least_gain_of_other_input)
        least = without, best = std::move(changed), taken = rows.size();
    }
    model.suppose_input(i, best);
    count += taken;
  }
  return count;
}

}  // namespace loopwright::diagnosis
