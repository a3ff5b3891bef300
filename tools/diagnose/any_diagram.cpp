#include "tools/diagnose/any_diagram.h"
#include "engine/diagram/in_memory.h"
#include "engine/json/json.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/improvement.h"
#include "tools/diagnose/predict/divergence.h"
#include "tools/diagnose/search/leaps_of_input.h"
#include "tools/diagnose/search/own_shapes.h"
#include "tools/diagnose/search/site_opinion.h"
#include "tools/diagnose/verdict/plots.h"
#include "tools/diagnose/verdict/site_verdict.h"
#include "tools/diagnose/verdict/trial_run.h"
#include "tools/diagnose/verdict/verdict.h"

namespace loopwright {
namespace {

using namespace diagnosis;

struct UserFiles {
  std::shared_ptr<const SourceFile> diagram;
  std::vector<std::shared_ptr<const Experiment>> experiments;
};
/// Throws InputError.
UserFiles files_of(const Diagnosis& result) {
  Problems problems;
  UserFiles files{read_source(result.diagram, {}, problems), load_experiments(result.experiments, problems)};
  if (problems.has_errors()) throw InputError(std::move(problems));
  return files;
}

/// The diagram with what was found, in memory. Throws InputError.
Improvement improvement_with(const DiagnoseOptions& options, const Diagnosis& result,
                             const Additions& additions) {
  const UserFiles files = files_of(result);
  return improve(files.diagram, files.experiments, options.load, additions);
}

/// What cannot be simulated explains nothing, whether its diagram is asked for or not.
void try_improved(const DiagnoseOptions& options, Diagnosis& result) {
  const Additions& additions = options.writes_all ? result.all_additions : result.additions;
  const bool is_asked_for = !options.improved_diagram.empty();
  if (!is_asked_for && additions.effects.empty() && additions.parameters.empty()) return;
  try {
    const UserFiles files = files_of(result);
    const Improvement improved = improve(files.diagram, files.experiments, options.load, additions);
    const bool usable = is_usable(improved, files.diagram, files.experiments, options.load, result);
    if (!usable && result.verdict == Verdict::explained) result.verdict = Verdict::partly_explained;
    if (usable && is_asked_for) write_improved(improved, options, result);
  } catch (const InputError&) {
    if (is_asked_for) throw;
  }
}

/// Nothing where the improved diagram cannot be made: `-o` says why.
report::Graph picture_of_improved(const DiagnoseOptions& options, const Diagnosis& result) {
  if (result.additions.effects.empty()) return {};
  try {
    return picture_of(improvement_with(options, result, result.additions), options.load);
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace

Diagnosis diagnose_any_diagram(const std::string& diagram, const std::vector<std::string>& experiments,
                               const DiagnoseOptions& options) {
  const ShapeCatalogue catalogue(options.catalogues, options.more_catalogues);
  const std::function<void(const char*, double)> progress = [&](const char* stage, double done) {
    if (options.progress) options.progress(stage, done);
  };
  const auto is_interrupted = [&] { return options.interrupt && *options.interrupt; };
  progress("reading the record", 0);
  SiteModel model(diagram, experiments, options.load);
  const double most_work = options.most_work.value_or(criteria::most_work_at_sites);
  model.work() = Work(most_work);
  SiteFilter filter(model);
  SiteFitter fitter(filter, model.record().held_out_from, is_interrupted);
  fitter.offer(catalogue.shapes());
  Diagnosis result;
  result.has_roles = false;
  result.diagram = diagram, result.experiments = experiments, result.title = model.plan().title;
  show_output(model.record().outputs.front(), result);
  result.rows = model.record().fitted_rows();
  if (model.record().shortened) result.findings.push_back(*model.record().shortened);
  if (const size_t count = model.record().false_readings; count > 0)
    result.findings.push_back(readings_are_false(count, "they count as missing"));
  bool begins_anew = false;
  for (const RecordedOutput& output : model.record().outputs)
    if (output.leaps_by_a_turn > 0)
      result.findings.push_back(angle_leaps(output.port, output.leaps_by_a_turn)), begins_anew = true;
  if (const size_t count = take_unfelt_leaps_away(fitter); count > 0)
    result.findings.push_back(inputs_are_not_felt(count));
  const auto found = search_with_second_opinion(fitter, progress);
  if (is_interrupted()) {
    result.was_interrupted = true;
    return result;
  }
  if (!found) {
    result.verdict = Verdict::unexplained;
    const std::string where = told_divergence(filter);
    result.findings.push_back(
        {"the diagram diverges along the record, although it is corrected at every row" +
             (where.empty() ? "" : ", " + where),
         "nothing can be said: units, signs or parameters are far off", true, false});
    return result;
  }
  result.trail = found->trail;
  result.trail.push_back("work: " + told_operations(model.work().done()));
  if (model.work().was_short()) result.findings.push_back(ended_at_limit(most_work));
  progress("prediction, simulation and verdict", 0.95);
  tell_sites(filter, *found, result);
  if (begins_anew) result.verdict = Verdict::unexplained;
  result.picture = picture_of_improved(options, result);
  try_improved(options, result);
  return result;
}

}  // namespace loopwright
