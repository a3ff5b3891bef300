/// Parameters refined by simulation error, with the same function as `loopwright fit`.
#include <fmt/format.h>
#include "engine/json/reader.h"
#include "tools/report/typography.h"
#include "tools/studio/session/session.h"
#include "tools/studio/session/shell_command.h"

namespace loopwright::studio {
namespace {

std::string quantity(double value, const std::string& unit) {
  return report::shown(value, unit == "1" ? "" : unit);
}

Json fit_json(const Fit& fit) {
  Json json{{"converged", fit.has_converged}, {"simulations", fit.simulations}, {"text", to_text(fit)},
            {"warnings", fit.warnings},       {"parameters", Json::array()},    {"signals", Json::array()}};
  for (const FittedParameter& p : fit.parameters)
    json["parameters"].push_back(
        {{"name", p.path},
         {"start", quantity(p.start, p.unit)},
         {"value", quantity(p.value, p.unit)},
         {"interval", p.is_determined ? quantity(p.low, p.unit) + " … " + quantity(p.high, p.unit) : ""},
         {"determined", p.is_determined},
         {"at_limit", p.value <= p.least || p.value >= p.most}});
  for (const FittedSignal& s : fit.signals)
    json["signals"].push_back({{"name", s.name},
                               {"unit", s.unit},
                               {"before", s.before},
                               {"after", s.after},
                               {"held_out_before", s.held_out_before},
                               {"held_out_after", s.held_out_after}});
  return json;
}

}  // namespace

Json Session::fit(const Request& request) {
  const std::string path = file_of(request);
  const Document& fitted = document(request.required("path"));
  if (!fitted.is_saved()) throw Refused("the text is not JSON yet: only a file that loads can be fitted");
  const int64_t revision = fitted.revision();
  std::vector<std::string> experiments, parameters = request.texts("parameters");
  for (const std::string& name : request.texts("experiments")) experiments.push_back(folder_.path_of(name));
  if (experiments.empty()) throw Refused("a fit needs an experiment");
  if (parameters.empty()) throw Refused("no parameter is chosen");
  const LoadOptions load = request.options();
  return start(request, [=, this](Work& work) -> Json {
    FitOptions options;
    options.interrupt = &work.job.interrupt();
    options.progress = [&](int iteration, double error) {
      work.progress(fmt::format("iteration {}, relative error {:.3g}", iteration, error),
                    double(iteration) / options.most_iterations);
    };
    auto result = std::make_shared<Fit>(loopwright::fit(path, experiments, parameters, load, options));
    if (result->was_interrupted) throw Refused("the fit was interrupted");
    std::string command = "loopwright fit " + shell_word(path), list;
    for (const std::string& experiment : experiments) command += " " + shell_word(experiment);
    for (const std::string& parameter : parameters) list += (list.empty() ? "" : ",") + parameter;
    command += " --parameters " + shell_word(list) + options_text(load);
    Json json{{"fit", results_.fits.add(std::make_shared<StoredFit>(StoredFit{result, revision}))},
              {"command", std::move(command)}};
    json.update(fit_json(*result));
    return json;
  });
}

Json Session::write_fit(const Request& request) {
  const auto stored = results_.fits.find(request.whole("fit", 0));
  if (!stored) throw Refused("this fit is not kept any more");
  const std::string path = file_of(request);
  return changed(request, [&](Document& document) {
    if (document.revision() != stored->revision)
      throw Refused("the diagram was changed since the fit: fit it again");
    Problems problems;
    const std::string text = with_fitted_values(path, *stored->fit, problems);
    if (problems.has_errors()) throw InputError(std::move(problems));
    return document.take("write fitted values", text, {}, {});
  });
}

}  // namespace loopwright::studio
