#include "tools/diagnose/diagnose.h"
#include <fmt/format.h>
#include <algorithm>
#include <limits>
#include "tools/diagnose/any_diagram.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/inquiry.h"
#include "tools/diagnose/record/doubts_about_time.h"
#include "tools/diagnose/search/catalogue.h"
#include "tools/diagnose/search/conclude.h"
#include "tools/diagnose/search/doubt.h"
#include "tools/diagnose/search/friction_at_reversals.h"
#include "tools/diagnose/search/late_log.h"
#include "tools/diagnose/search/leaps_of_input.h"
#include "tools/diagnose/search/noisy_input.h"
#include "tools/diagnose/search/remaining_force.h"
#include "tools/diagnose/search/replacement.h"
#include "tools/diagnose/verdict/acceptance.h"
#include "tools/diagnose/verdict/common_factor.h"
#include "tools/diagnose/verdict/found_parameters.h"
#include "tools/diagnose/verdict/improve.h"
#include "tools/diagnose/verdict/plots.h"
#include "tools/diagnose/search/prepare.h"
#include "tools/diagnose/search/search.h"
#include "tools/experiment/stated_roles.h"
#include "tools/diagnose/search/unknown.h"
#include "tools/diagnose/verdict/trial_run.h"
#include "tools/diagnose/verdict/verdict.h"

namespace loopwright {
namespace {

using namespace diagnosis;

MachineUnits units_of(const AxisModel& model) {
  MachineUnits units;
  units.force = model.force_unit(), units.input = model.record().input_unit;
  const MeasuredPort* position = model.record().find("position");
  if (position)
    units.position = position->unit;
  else if (model.position_unit().size())
    units.position = model.position_unit();
  return units;
}

const Effect& effect_of(const Catalogue& catalogue, const Candidate* candidate) {
  return catalogue.effects[size_t(candidate - catalogue.candidates.data())];
}

/// Whether the result explains everything, including a motion that leads its input: only a load that swings
/// or rattles makes an axis look like that.
bool explains_lead(const Conclusion& conclusion) {
  const auto names = [&](std::string_view name) {
    return std::ranges::any_of(conclusion.estimate.members,
                               [&](const Member& m) { return m.candidate->name == name; });
  };
  return conclusion.is_white() && !names("unknown") && (names("flexible_mode") || names("backlash"));
}

void suggest(std::vector<SuggestedExperiment>& list, SuggestedExperiment experiment) {
  const bool is_there = std::ranges::any_of(list, [&](const SuggestedExperiment& e) {
    return e.between == experiment.between && e.and_effect == experiment.and_effect;
  });
  if (!is_there) list.push_back(std::move(experiment));
}

}  // namespace

std::string_view name_of(Verdict verdict) {
  constexpr std::string_view names[] = {"nothing_missing", "explained", "partly_explained", "unexplained"};
  return names[size_t(verdict)];
}

namespace {

/// What can be concluded to the extent that the records permit; faults found in them are corrected.
Conclusion conclusion_from(Inquiry& inquiry, std::vector<RecordFinding>& findings) {
  const auto is_certain = [](const RecordFinding& f) { return f.is_fatal && !f.may_be_physics; };
  const auto is_doubtful = [](const RecordFinding& f) { return f.is_fatal && f.may_be_physics; };
  if (std::ranges::any_of(findings, is_certain)) return inquiry.without_names();
  Conclusion conclusion = inquiry.with_names();
  if (inquiry.fits_all_rows())
    findings.push_back({"the part that was to be held out shows something that the other part does not",
                        "it was used for the fit too, and no error is held out"});
  if (explains_lead(conclusion))
    std::erase_if(findings, is_doubtful);
  else if (std::ranges::any_of(findings, is_doubtful))
    return inquiry.without_names();  // names from a record that does not support them would be guesses
  return conclusion;
}

/// In the order of the staircase; but members that another effect could replace come after certain members,
/// before the optional ones.
std::vector<size_t> ranked(const Conclusion& conclusion, const Staircase& staircase) {
  size_t needed = 0;
  for (const DiagnosisStep& step : staircase.steps)
    if (!step.is_optional) needed += step.added.size();
  std::vector<size_t> order = staircase.order;
  std::stable_partition(order.begin(), order.begin() + std::ptrdiff_t(needed),
                        [&](size_t m) { return conclusion.inclusion[m] >= criteria::sure; });
  return order;
}

/// Effects by rank, alternatives, and the experiments that would distinguish them.
void tell_effects(const Conclusion& conclusion, const Staircase& staircase, const Catalogue& catalogue,
                  const MachineUnits& units, Diagnosis& result) {
  std::vector<size_t> optional;
  for (size_t step = staircase.necessary(); step < staircase.steps.size(); ++step)
    std::ranges::copy(staircase.added[step], std::back_inserter(optional));
  for (size_t index : ranked(conclusion, staircase)) {
    const Member& member = conclusion.estimate.members[index];
    if (member.candidate->is_unknown) continue;
    const Effect& effect = effect_of(catalogue, member.candidate);
    DiagnosedEffect found{effect.name,
                          effect.form,
                          effect.title,
                          effect.physics,
                          parameters_of_member(conclusion, index, units),
                          wave_of_member(conclusion, index, units),
                          conclusion.inclusion[index],
                          {},
                          conclusion.weights[index].force_rms,
                          conclusion.weights[index].loss,
                          std::ranges::find(optional, index) != optional.end()};
    for (const Substitute& other : conclusion.substitutes[index]) {
      if (std::ranges::find(found.alternatives, other.candidate->name) != found.alternatives.end()) continue;
      if (other.candidate->name == effect.name) continue;
      found.alternatives.push_back(other.candidate->name);
      suggest(result.suggested, separating_experiment(effect, other.candidate->name));
    }
    result.effects.push_back(std::move(found));
  }
  for (const OtherSet& other : conclusion.other_sets) {
    OtherExplanation& explanation = result.other_explanations.emplace_back();
    for (const Candidate* c : other.replaced) explanation.in_place_of.push_back(c->name);
    for (const Candidate* c : other.by) explanation.effects.push_back(c->name);
    const auto is_new = [&](const Candidate* c) {
      return std::ranges::find(other.replaced, c) == other.replaced.end();
    };
    const auto rival = std::ranges::find_if(other.by, is_new);
    suggest(result.suggested,
            separating_experiment(effect_of(catalogue, other.replaced.front()),
                                  (rival == other.by.end() ? other.by.front() : *rival)->name));
  }
}

void forget_residual_force(Diagnosis& result) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  for (DiagnosisStep& step : result.steps) step.force_rmse = step.held_out_force_rmse = unknown;
  result.error_before = result.error_after = unknown;
}

/// Zero would look like a perfect answer.
void forget_what_no_row_shows(Diagnosis& result) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  for (DiagnosisStep& step : result.steps)
    if (result.holds_out && step.held_out_force_rmse == 0) step.held_out_force_rmse = unknown;
  if (result.holds_out && result.held_out_mean_square == 0) result.held_out_mean_square = unknown;
  if (result.rows == 0) result.mean_square = unknown;
}

void tell_errors(const Trials& trials, const Conclusion& conclusion, const Inquiry& inquiry,
                 Diagnosis& result) {
  const auto error = [&](const DiagnosisStep& step) {
    return result.holds_out && step.held_out_force_rmse > 0 ? step.held_out_force_rmse : step.force_rmse;
  };
  result.error_before = error(result.steps.front()), result.error_after = error(result.steps.back());
  const AxisModel& model = *trials.list.front().model;
  const double inertia = model.nominal_inertia() + added_inertia(conclusion.estimate.members);
  const Noise noise = conclusion.estimate.noise.at_inertia(inertia / model.nominal_inertia());
  result.noise_floor = residual_floor(trials, conclusion.estimate);
  result.rows = fitted_numbers(trials) / trials.ports();
  result.mean_square = conclusion.estimate.mean_square;
  result.held_out_mean_square = inquiry.held_out_mean_square();
  result.portmanteau = conclusion.portmanteau;
  result.white_force = noise.white, result.slow_force = noise.slow();
  result.slow_force_time_s = -model.record().sample_time / std::log(noise.memory);
  result.measurement_noise = noise.measurement;
}

/// The catalogue for these records, with why each effect that is left out is not looked for.
Catalogue catalogue_for(const Trials& trials, const std::vector<const AxisModel*>& models, bool is_smoothed,
                        const WhyNot& cannot_be_added, const DiagnoseOptions& options,
                        const MachineUnits& units, const RecordSizes& sizes, const Motion& motion) {
  std::vector<std::string> folders =
      options.catalogues.empty() ? std::vector<std::string>{catalogue_folder()} : options.catalogues;
  std::ranges::copy(options.more_catalogues, std::back_inserter(folders));
  const auto knows_more = [](const AxisModel* m) { return m->record().controller_may_know_more(); };
  const auto why_not = [&](const Effect& effect) {
    std::string why = trials.has_map() ? not_in_a_map(effect) : std::string();
    if (why.empty() && is_smoothed) why = hidden_by_input_noise(effect);
    if (why.empty() && std::ranges::any_of(models, knows_more)) why = hidden_by_controller(effect);
    return why.empty() ? cannot_be_added(effect) : why;
  };
  return make_catalogue(folders, units, sizes, why_not, has_uneven_rows(motion.paths));
}

/// What was refused, what is too small, and what the simulations are like.
void tell_acceptance(const Trials& trials, const Catalogue& catalogue, Acceptance& accepted,
                     Diagnosis& result) {
  result.refused = std::move(accepted.refused);
  for (const SmallEffect& small : accepted.conclusion.too_small)
    result.too_small.push_back({effect_of(catalogue, small.candidate).name, small.force_rms,
                                small.force_rms / std::max(trials.force_rms, 1e-300), small.gain});
  if (!accepted.why_not_run.empty()) result.contradictions.push_back(std::move(accepted.why_not_run));
  result.steps = accepted.staircase.steps;
  if (!accepted.runs.empty())
    result.simulation_horizon_s = accepted.runs.back().horizon_s,
    result.simulation_diverged = accepted.diverges, result.simulation_is_worse = accepted.is_worse;
}

/// What limits the answer beside the faults of the record.
void tell_limits(const Trials& trials, const Acceptance& accepted, const RecordSizes& sizes,
                 const MachineUnits& units, Diagnosis& result) {
  const Estimate& estimate = accepted.conclusion.estimate;
  const double white = estimate.noise.white;
  if (white > criteria::loud_noise * trials.force_rms && !trials.has_map())
    result.findings.push_back(noise_is_loud(white / trials.force_rms, shortest_pitch(sizes), units));
  if (auto finding = friction_along_the_way(trials, estimate)) result.findings.push_back(std::move(*finding));
  if (accepted.has_few_simulations()) result.findings.push_back(too_few_simulations(accepted.runs.back()));
}

/// What else the input has that the machine does not feel, beside what was found.
std::optional<InputCorrection> other_correction(Trials& trials, Conclusion& conclusion,
                                                const Catalogue& catalogue, InputCorrection correction) {
  if (const auto rows = rows_logged_late(trials, conclusion.estimate, conclusion.trail)) {
    correction.rows_late = *rows;
    return correction;
  }
  return noise_instead_of_late_input(trials, conclusion.estimate, catalogue.candidates.size());
}

/// `correction`: see AxisModel. A record that asks for another one is read again with it.
Diagnosis diagnose_to_the_end(const std::string& diagram, const std::vector<std::string>& experiments,
                              const DiagnoseOptions& options, const InputCorrection& correction = {}) {
  const std::function<void(const char*, double)> progress = [&](const char* stage, double done) {
    if (options.progress) options.progress(stage, done);
  };
  progress("reading the records", 0);
  Motion motion;
  Trials trials = prepare(diagram, experiments, options.load, motion, correction);
  const bool is_as_recorded =
      correction.rows == 0 && correction.leaps == InputLeaps::felt && correction.rows_late == 0;
  if (const auto leaps =
          is_as_recorded ? unfelt_leaps(diagram, experiments, options.load, trials) : std::nullopt)
    return diagnose_to_the_end(diagram, experiments, options, InputCorrection{.leaps = *leaps});
  const bool is_smoothed = correction.rows > 0;
  trials.interrupt = options.interrupt;
  const double most_work = options.most_work.value_or(criteria::most_work);
  *trials.work = Work(most_work);
  std::vector<const AxisModel*> models;
  for (const Trial& trial : trials.list) models.push_back(trial.model.get());
  const MachineUnits units = units_of(*models.front());
  const RecordSizes sizes = sizes_of(motion.paths, models);
  const Catalogue catalogue =
      catalogue_for(trials, models, is_smoothed, attachable(diagram, experiments, options.load, units, sizes),
                    options, units, sizes, motion);
  std::vector<InverseDynamics> inverse;
  for (Trial& trial : trials.list) inverse.push_back(inverse_dynamics(trial));
  trials.inverse = &inverse;
  if (options.found)
    trials.found = [&](const std::vector<Member>& members) {
      std::vector<std::string> names;
      for (const Member& member : members) names.push_back(shown_name(*member.candidate));
      options.found(names, residual_size(trials, inverse, members).fitted);
    };
  Diagnosis result;
  result.findings = look_at_records(trials, inverse);
  if (auto finding = too_few_rows(trials))
    result.findings.push_back(std::move(*finding)), result.has_too_few_rows = true;
  result.not_looked_for = catalogue.left_out;
  Inquiry inquiry(trials, motion, catalogue, sizes, progress);
  const Improver improver(diagram, experiments, options.load, catalogue, units, sizes);
  progress("simulating the diagram with the effects", 0.85);
  Acceptance accepted =
      accept(conclusion_from(inquiry, result.findings), trials, inverse, improver, options.load,
             catalogue.candidates.size(),
             [&](const Conclusion& c, size_t member) { return inquiry.without(c, member); });
  if (is_smoothed)
    result.findings.push_back(input_is_noisy(trials, correction));
  else if (const auto better = other_correction(trials, accepted.conclusion, catalogue, correction))
    return diagnose_to_the_end(diagram, experiments, options, *better);
  if (trials.work->was_short()) result.findings.push_back(ended_at_limit(most_work));
  const Conclusion& conclusion = accepted.conclusion;
  const Staircase& staircase = accepted.staircase;
  tell_acceptance(trials, catalogue, accepted, result);
  result.holds_out = std::ranges::any_of(
      trials.list, [](const Trial& trial) { return trial.held_out_from < trial.usable.size(); });
  result.diagram = diagram, result.experiments = experiments, result.trail = conclusion.trail;
  result.title = models.front()->plan().title;
  result.force_unit = units.force, result.position_unit = units.position;
  result.measured_unit = models.front()->record().measured.front().unit;
  tell_limits(trials, accepted, sizes, units, result);
  tell_effects(conclusion, staircase, catalogue, units, result);
  if (!trials.has_map()) tell_common_factor(trials, inverse, result);
  tell_errors(trials, conclusion, inquiry, result);
  trials.run_along(Trials::Rows::all);
  judge(trials, conclusion, inquiry.motion_of_all_rows(), search_noise(trials), inverse, result);
  forget_what_no_row_shows(result);
  if (!balances_forces(trials, inverse)) forget_residual_force(result);
  const auto members_of = [&](size_t steps) { return staircase.members[steps - 1]; };
  result.additions = improver.additions(members_of(staircase.necessary()));
  result.all_additions = improver.additions(members_of(staircase.steps.size()));
  if (!options.improved_diagram.empty()) {
    const Improvement improved =
        improver.with(members_of(options.writes_all ? staircase.steps.size() : staircase.necessary()));
    if (is_usable(improved, improver.file(), improver.experiments(), options.load, result))
      write_improved(improved, options, result);
  }
  add_plots(trials, inverse.front(), accepted, improver, units, options.load, result);
  result.trail.push_back("work: " + told_operations(trials.work->done()));
  return result;
}

}  // namespace

Diagnosis diagnose(const std::string& diagram, const std::vector<std::string>& experiments,
                   const DiagnoseOptions& options) {
  try {
    const bool has_roles = have_roles(experiments);
    const auto doubts = doubts_about_time(diagram, experiments, options.load, has_roles);
    Diagnosis result = has_roles ? diagnose_to_the_end(diagram, experiments, options)
                                 : diagnose_any_diagram(diagram, experiments, options);
    result.findings.insert(result.findings.end(), doubts.begin(), doubts.end());
    return result;
  } catch (const Interrupted&) {
    Diagnosis result;
    result.was_interrupted = true;
    return result;
  }
}

}  // namespace loopwright
