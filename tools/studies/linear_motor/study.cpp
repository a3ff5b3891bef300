#include "tools/studies/linear_motor/study.h"
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include "engine/record/recording_file.h"

namespace loopwright::paper {
namespace {

// Noise is a function of the run's number: training, evaluation and tracking always have different noise.
constexpr int64_t first_training = 0, first_evaluation = 1000, first_tracking = 2000;

std::string file(const std::string& diagrams, const char* name) { return diagrams + "/" + name + ".json"; }

Controller conventional(const std::string& diagrams) {
  return {"conventional", "Conventional", file(diagrams, "conventional"), {}};
}

Controller learned(std::string key, std::string title, const std::string& diagram, const StudyModel& model) {
  const std::string path = std::filesystem::absolute(model.path).string();
  return {std::move(key), std::move(title), diagram, {.set = {{"model", path}}}};
}

Controller with(Controller controller, std::string key, std::string title, const LoadOptions& changes) {
  controller.key = std::move(key), controller.title = std::move(title);
  controller.changes.set.insert(controller.changes.set.end(), changes.set.begin(), changes.set.end());
  controller.changes.variants.insert(changes.variants.begin(), changes.variants.end());
  return controller;
}

const Controller& named(const std::vector<Controller>& controllers, std::string_view key) {
  const auto found = std::ranges::find(controllers, key, &Controller::key);
  if (found == controllers.end()) throw std::out_of_range(fmt::format("no controller {}", key));
  return *found;
}

/// The two motions, and the conditions that disturb the phase of a learned compensation.
std::vector<Condition> telling_conditions() {
  std::vector<Condition> conditions{paper_condition(), held_out_condition()};
  for (Condition& condition : harder_conditions())
    if (condition.key == "homing1mm" || condition.key == "delay1") conditions.push_back(std::move(condition));
  return conditions;
}

Comparison one_change_at_a_time(const StudyOptions& o, const Study& s) {
  const Controller& ps = named(s.comparison.controllers, "ps");
  const Controller& beyond = named(s.comparison.controllers, "beyond");
  const Controller undelayed = learned("", "", ps.diagram, s.models.ps_undelayed);
  // Delay of the compensation: that of its filter and the sample after which it acts.
  const LoadOptions lead{.set = {{"compensation.lead", "=1/(2*pi*100) + 0.001"}}};
  const LoadOptions still{.set = {{"phase.distance", "1e9"}}};
  return compare({ps, with(ps, "lead", "with lead", lead),
                  with(undelayed, "undelayed", "and labels without delay", lead),
                  with(beyond, "product", "and velocity in the cogging", still),
                  with(beyond, "beyond", "and a followed phase: beyond", {})},
                 telling_conditions(), o.runs);
}

Comparison with_variance_aware(const StudyOptions& o, const Study& s) {
  const LoadOptions fading{.variants = {{"compensation.prediction", "variance_aware"}}};
  std::vector<Controller> controllers;
  for (const char* key : {"ds", "ps", "beyond"}) {
    const Controller& plain = named(s.comparison.controllers, key);
    controllers.push_back(plain);
    controllers.push_back(with(plain, plain.key + "_aware", plain.title + ", variance-aware", fading));
  }
  return compare(std::move(controllers), {paper_condition(), held_out_condition(), payload_condition(1)},
                 o.runs);
}

Comparison over_payloads(const StudyOptions& o, const Study& s) {
  const auto& c = s.comparison.controllers;
  return compare(
      {named(c, "conventional"), named(c, "ds"), named(c, "ps")},
      {payload_condition(0.21), payload_condition(0.5), payload_condition(1), payload_condition(2)}, o.runs);
}

Comparison with_retuning(const StudyOptions& o, const Study& s) {
  const auto& c = s.comparison.controllers;
  const Controller& plain = named(c, "conventional");
  const LoadOptions faster{.set = {{"controller.observer_cutoff", "=2*pi*80"}}};
  return compare(
      {plain, with(plain, "wq80", "Observer at 80 Hz, not 40", faster), named(c, "ps"), named(c, "beyond")},
      telling_conditions(), o.runs);
}

using Json = nlohmann::ordered_json;

Json means(const std::array<Spread, 3>& values) {
  Json list = Json::array();
  for (const Spread& value : values) list.push_back(value.mean);
  return list;
}

/// {"conventional": …, "ds": …} in µm, and the deviations under "deviation".
Json errors_um(const Comparison& comparison, const Tracking& tracking) {
  Json object, deviations;
  for (size_t i = 0; i < tracking.errors.size(); ++i) {
    object[comparison.controllers[i].key] = 1e6 * tracking.errors[i].mean;
    deviations[comparison.controllers[i].key] = 1e6 * tracking.errors[i].deviation;
  }
  object["deviation"] = deviations;
  return object;
}

}  // namespace

const Spread& Comparison::at(std::string_view condition, std::string_view controller) const {
  for (const Tracking& tracking : rows)
    for (size_t i = 0; i < controllers.size(); ++i)
      if (tracking.condition.key == condition && controllers[i].key == controller) return tracking.errors[i];
  throw std::out_of_range(fmt::format("no {} under {}", controller, condition));
}

std::string record_experiment(const std::string& diagrams, Purpose purpose, int run,
                              const std::string& folder) {
  const bool trains = purpose == Purpose::training;
  const int64_t number = (trains ? first_training : first_evaluation) + run;
  const std::string path = fmt::format("{}/{}_{}.csv", folder, trains ? "identification" : "evaluation", run);
  write_recording(path, run_diagram(file(diagrams, "identification"), {}, number));
  return path;
}

PredictionErrors prediction_errors(const std::string& diagrams, const Models& first, int runs,
                                   const std::string& folder) {
  const std::string ds_file = diagrams + "/ds.training.json", ps_file = diagrams + "/ps.training.json",
                    undelayed_file = diagrams + "/beyond.training.json";
  std::array<std::vector<double>, 3> ds, ps, undelayed_ds, undelayed_ps;
  for (int run = 0; run < runs; ++run) {
    const std::string evaluation = record_experiment(diagrams, Purpose::evaluation, run, folder);
    const std::string training =
        run > 0 ? record_experiment(diagrams, Purpose::training, run, folder) : std::string();
    const gp::Samples late = samples_of({ps_file, evaluation, 0, ""}),
                      undelayed = samples_of({undelayed_file, evaluation, 0, ""});
    for (size_t k = 0; k < 3; ++k) {
      const StudyModel d =
          run > 0 ? train_model({ds_file, training, window_lengths[k], ""}, "DS") : first.ds[k];
      const StudyModel p =
          run > 0 ? train_model({ps_file, training, window_lengths[k], ""}, "PS") : first.ps[k];
      ds[k].push_back(d.rmse(late)), undelayed_ds[k].push_back(d.rmse(undelayed));
      ps[k].push_back(p.rmse(late)), undelayed_ps[k].push_back(p.rmse(undelayed));
    }
  }
  PredictionErrors errors;
  for (size_t k = 0; k < 3; ++k) {
    errors.ds[k] = spread_of(ds[k]), errors.undelayed_ds[k] = spread_of(undelayed_ds[k]);
    errors.ps[k] = spread_of(ps[k]), errors.undelayed_ps[k] = spread_of(undelayed_ps[k]);
  }
  return errors;
}

std::vector<Controller> controllers_of(const std::string& diagrams, const Models& models) {
  return {conventional(diagrams), learned("ds", "DS", file(diagrams, "ds"), models.ds[1]),
          learned("ps", "PS", file(diagrams, "ps"), models.ps[1]),
          learned("beyond", "Beyond", file(diagrams, "beyond"), models.beyond)};
}

Comparison compare(std::vector<Controller> controllers, std::vector<Condition> conditions, int runs) {
  Comparison comparison{std::move(controllers), {}};
  for (Condition& condition : conditions) {
    Tracking tracking{std::move(condition), {}};
    for (const Controller& controller : comparison.controllers)
      tracking.errors.push_back(tracking_rmse(controller, tracking.condition, first_tracking, runs));
    comparison.rows.push_back(std::move(tracking));
  }
  return comparison;
}

FigureRuns figure_runs(const std::vector<Controller>& controllers) {
  const auto run = [&](const char* controller, const Condition& condition) {
    return track(named(controllers, controller), condition, first_tracking);
  };
  const Condition paper = paper_condition(), loaded = payload_condition(1);
  return {run("conventional", paper), run("ds", paper), run("ps", paper), run("ds", loaded),
          run("ps", loaded)};
}

Study run_study(const StudyOptions& o) {
  const auto say = [&](const char* what) {
    if (o.progress) o.progress(what);
  };
  Study s;
  s.runs = o.runs;
  say("identification experiment and training");
  std::filesystem::create_directories(o.output);
  s.models =
      train_models(o.diagrams, record_experiment(o.diagrams, Purpose::training, 0, o.output), o.output);
  s.trained = trained_stretches(s.models.ps[1]);
  say("Table 1");
  s.prediction = prediction_errors(o.diagrams, s.models, std::min(o.runs, 3), o.output);
  say("tracking: Table 2, held-out motion and harder conditions");
  std::vector<Condition> conditions = harder_conditions();
  conditions.insert(conditions.begin(), {paper_condition(), held_out_condition()});
  s.comparison = compare(controllers_of(o.diagrams, s.models), conditions, o.runs);
  say("variations");
  s.steps = one_change_at_a_time(o, s);
  s.variance_aware = with_variance_aware(o, s);
  s.payloads = over_payloads(o, s);
  s.retuned = with_retuning(o, s);
  say("figures");
  s.figures = figure_runs(s.comparison.controllers);
  s.beyond = track(named(s.comparison.controllers, "beyond"), paper_condition(), first_tracking);
  s.response = measured_response(run_diagram(file(o.diagrams, "frequency_response"), {}, first_tracking));
  s.statements = check_statements(s.figures, s.trained);
  return s;
}

std::string to_json(const Study& study) {
  Json json;
  json["runs"] = study.runs;
  json["units"] = {{"table1", "V"}, {"tracking", "um"}};
  json["table1"] = {{"ds", means(study.prediction.ds)}, {"ps", means(study.prediction.ps)}};
  for (const Tracking& tracking : study.comparison.rows)
    json[tracking.condition.key == "paper" ? "table2" : tracking.condition.key] =
        errors_um(study.comparison, tracking);
  for (const auto& [key, comparison] : {std::pair{"steps", &study.steps},
                                        {"variance_aware", &study.variance_aware},
                                        {"payloads", &study.payloads},
                                        {"retuned", &study.retuned}})
    for (const Tracking& tracking : comparison->rows)
      json[key][tracking.condition.key] = errors_um(*comparison, tracking);
  for (const Statement& statement : study.statements)
    json["statements"][statement.key] = {
        {"figure", statement.figure}, {"holds", statement.holds}, {"measured", statement.measured}};
  return json.dump(2) + "\n";
}

}  // namespace loopwright::paper
