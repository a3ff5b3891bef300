#include "tools/diagnose/any_diagram.h"
#include <fmt/format.h>
#include "tools/diagnose/verdict/site_verdict.h"

namespace loopwright {
namespace {

using namespace diagnosis;

void reject_options_of_an_axis(const std::string& experiment, const DiagnoseOptions& options) {
  Problems problems;
  const auto reject = [&](const char* option) {
    auto& p = problems.error({}, "", "", fmt::format("{} has no meaning without roles", option));
    p.found = experiment;
    p.hint = "name the roles of an axis in the experiment, or leave the option out";
  };
  if (!options.catalogues.empty()) reject("--effects");
  if (!options.improved_diagram.empty()) reject("-o");
  if (problems.has_errors()) throw InputError(std::move(problems));
}

}  // namespace

Diagnosis diagnose_any_diagram(const std::string& diagram, const std::string& experiment,
                               const DiagnoseOptions& options) {
  reject_options_of_an_axis(experiment, options);
  const std::function<void(const char*, double)> progress = [&](const char* stage, double done) {
    if (options.progress) options.progress(stage, done);
  };
  const auto is_interrupted = [&] { return options.interrupt && *options.interrupt; };
  progress("reading the record", 0);
  SiteModel model(diagram, experiment, options.load);
  SiteFilter filter(model);
  SiteFitter fitter(filter, model.record().held_out_from, is_interrupted);
  Diagnosis result;
  result.has_roles = false;
  result.diagram = diagram, result.experiments = {experiment}, result.title = model.plan().title;
  result.force_unit = result.measured_unit = model.record().outputs.front().unit;
  result.measured_port = model.record().outputs.front().port;
  const auto found = search_sites(fitter, progress);
  if (is_interrupted()) {
    result.was_interrupted = true;
    return result;
  }
  if (!found) {
    result.verdict = Verdict::unexplained;
    result.findings.push_back({"the diagram diverges along the record, although it is corrected at every row",
                               "nothing can be said: units, signs or parameters are far off", true, false});
    return result;
  }
  result.trail = found->trail;
  progress("prediction, simulation and verdict", 0.95);
  tell_sites(filter, *found, result);
  return result;
}

}  // namespace loopwright
