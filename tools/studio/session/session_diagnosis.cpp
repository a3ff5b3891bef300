/// Diagnoses: the staircase while it grows, cards of effects, previews, and effects added to the diagram.
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "engine/json/reader.h"
#include "tools/diagnose/diagnose.h"
#include "tools/diagnose/improvement.h"
#include "tools/report/typography.h"
#include "tools/studio/session/experiment_text.h"
#include "tools/studio/session/session.h"

namespace loopwright::studio {
namespace {

double error_of(const Diagnosis& diagnosis, const DiagnosisStep& step) {
  return diagnosis.holds_out ? step.held_out_force_rmse : step.force_rmse;
}

Json steps_json(const Diagnosis& diagnosis) {
  Json list = Json::array();
  for (const DiagnosisStep& step : diagnosis.steps)
    list.push_back({{"added", step.added},
                    {"error", error_of(diagnosis, step)},
                    {"simulation", step.simulation_rmse},
                    {"optional", step.is_optional}});
  return list;
}

/// The step of the staircase that adds an effect, the `count`-th of its name.
const DiagnosisStep* step_of(const Diagnosis& diagnosis, const std::string& effect, size_t count) {
  for (const DiagnosisStep& step : diagnosis.steps)
    for (const std::string& added : step.added)
      if (added == effect && count-- == 0) return &step;
  return nullptr;
}

Json card_json(const Diagnosis& diagnosis, const DiagnosedEffect& effect, size_t count) {
  Json parameters = Json::array();
  for (const DiagnosedParameter& p : told_parameters(effect))
    parameters.push_back({{"name", p.name},
                          {"value", p.value},
                          {"low", p.low},
                          {"high", p.high},
                          {"unit", p.unit},
                          {"text", report::shown(p.value, p.unit)},
                          {"interval", report::shown(p.low, p.unit) + " … " + report::shown(p.high, p.unit)},
                          {"at_limit", p.at_limit}});
  const DiagnosisStep* step = step_of(diagnosis, effect.name, count);
  const bool is_addable = std::ranges::find(diagnosis.all_additions.effects, effect.name,
                                            &AddedEffect::name) != diagnosis.all_additions.effects.end();
  return {{"effect", effect.name},
          {"form", effect.form},
          {"title", effect.title},
          {"physics", effect.physics},
          {"inclusion", effect.inclusion},
          {"force", effect.force_rms},
          {"unit", diagnosis.force_unit},
          {"optional", step && step->is_optional},
          {"parameters", std::move(parameters)},
          {"rivals", effect.alternatives},
          {"error_with", step ? Json(error_of(diagnosis, *step)) : Json(nullptr)},
          {"addable", is_addable},
          {"why_not", is_addable ? "" : "it cannot be added to this diagram"}};
}

Json cards_json(const Diagnosis& diagnosis) {
  Json cards = Json::array();
  std::map<std::string, size_t> counts;
  for (const DiagnosedEffect& effect : diagnosis.effects)
    cards.push_back(card_json(diagnosis, effect, counts[effect.name]++));
  return cards;
}

/// What remains without a name; null if nothing does.
Json unknown_json(const Diagnosis& diagnosis) {
  const bool is_left =
      diagnosis.verdict == Verdict::unexplained || diagnosis.verdict == Verdict::partly_explained;
  if (!is_left) return nullptr;
  Json dependence = Json::array();
  for (const RemainderShare& share : diagnosis.dependence)
    dependence.push_back({{"variable", share.variable}, {"share", share.share}});
  // Functions that were learned without a name can be kept as they are: as lookup blocks.
  Json learned = Json::array();
  for (const AddedEffect& added : diagnosis.all_additions.effects)
    if (added.effect.name.starts_with("unknown_"))
      learned.push_back({{"effect", added.name}, {"title", added.effect.title}, {"note", added.note}});
  return {{"variables", diagnosis.remainder_variables},
          {"dependence", std::move(dependence)},
          {"learned", std::move(learned)},
          {"not_stated", diagnosis.all_additions.not_stated}};
}

/// The curves at rows that draw the residual before and after.
Json curves_json(const Diagnosis& diagnosis, size_t points) {
  const Diagnosis::Curves& c = diagnosis.curves;
  const size_t step = std::max<size_t>(1, c.before.size() / (2 * points));
  const auto taken = [&](const std::vector<double>& values) {
    std::vector<double> some;
    for (size_t i = 0; i < values.size(); i += step) some.push_back(values[i]);
    return some;
  };
  return {{"unit", diagnosis.force_unit},  {"time", taken(c.time)},     {"position", taken(c.position)},
          {"velocity", taken(c.velocity)}, {"before", taken(c.before)}, {"after", taken(c.after)}};
}

Json diagnosis_json(const Diagnosis& diagnosis, size_t points) {
  Json json{{"verdict", name_of(diagnosis.verdict)},
            {"title", diagnosis.title},
            {"text", to_text(diagnosis)},
            {"error_before", diagnosis.error_before},
            {"error_after", diagnosis.error_after},
            {"noise_floor", diagnosis.noise_floor},
            {"unit", diagnosis.force_unit},
            {"holds_out", diagnosis.holds_out},
            {"steps", steps_json(diagnosis)},
            {"cards", cards_json(diagnosis)},
            {"other_explanations", Json::array()},
            {"suggested", Json::array()},
            {"findings", Json::array()},
            {"not_looked_for", Json::array()},
            {"unknown", unknown_json(diagnosis)},
            {"curves", curves_json(diagnosis, points)}};
  for (const OtherExplanation& other : diagnosis.other_explanations)
    json["other_explanations"].push_back({{"in_place_of", other.in_place_of}, {"effects", other.effects}});
  for (const SuggestedExperiment& suggested : diagnosis.suggested)
    json["suggested"].push_back(
        {{"text", suggested.text}, {"between", suggested.between}, {"and", suggested.and_effect}});
  for (const RecordFinding& finding : diagnosis.findings)
    json["findings"].push_back({{"what", finding.what}, {"cost", finding.cost}, {"fatal", finding.is_fatal}});
  for (const NotLookedFor& left_out : diagnosis.not_looked_for)
    json["not_looked_for"].push_back({{"effects", left_out.effects}, {"why", left_out.why}});
  return json;
}

/// The named effects of a diagnosis; all that are not optional if none is named. Their values are those that
/// were fitted together with what is not optional, unless an optional one is among them. Throws Refused.
Additions chosen(const Diagnosis& diagnosis, const std::vector<std::string>& names) {
  if (names.empty() && !diagnosis.additions.effects.empty()) return diagnosis.additions;
  const auto has_name = [&](const AddedEffect& added) {
    return std::ranges::find(names, added.name) != names.end();
  };
  for (const Additions* all : {&diagnosis.additions, &diagnosis.all_additions}) {
    Additions some{{}, {}, all->parameters, all->units, all->sizes};
    std::ranges::copy_if(all->effects, std::back_inserter(some.effects), has_name);
    const auto is_there = [&](const std::string& name) {
      return std::ranges::find(some.effects, name, &AddedEffect::name) != some.effects.end();
    };
    if (!names.empty() && std::ranges::all_of(names, is_there)) return some;
  }
  throw Refused("the diagnosis has no such effect to add");
}

using Experiments = std::vector<std::shared_ptr<const Experiment>>;

Experiments read(const std::vector<std::string>& paths) {
  Problems problems;
  Experiments experiments = load_experiments(paths, problems);
  if (problems.has_errors()) throw InputError(std::move(problems));
  return experiments;
}

}  // namespace

Json Session::diagnose(const Request& request) {
  const std::string path = file_of(request);
  const std::vector<std::string> names = request.texts("experiments");
  if (names.empty()) throw Refused("a diagnosis needs an experiment");
  std::vector<std::string> experiments;
  for (const std::string& name : names) experiments.push_back(folder_.path_of(name));
  const LoadOptions load = request.options();
  const size_t points = size_t(std::clamp<int64_t>(request.whole("points", 1200), 10, 20'000));
  return start(request, [=, this](Work& work) -> Json {
    DiagnoseOptions options;
    options.load = load, options.interrupt = &work.job.interrupt();
    std::string stage;
    options.progress = [&](const char* now, double done) {
      stage = now;
      work.progress(now, done);
    };
    Json steps = Json::array();
    std::vector<std::string> before;
    options.found = [&](const std::vector<std::string>& effects, double force) {
      std::vector<std::string> added;
      for (const std::string& effect : effects)
        if (std::ranges::find(before, effect) == before.end()) added.push_back(effect);
      before = effects;
      steps.push_back({{"added", std::move(added)}, {"effects", effects}, {"error", force}});
      work.partial({{"steps", steps}, {"stage", stage}});
    };
    auto diagnosis = std::make_shared<Diagnosis>(loopwright::diagnose(path, experiments, options));
    if (diagnosis->was_interrupted) throw Refused("the diagnosis was interrupted");
    const int64_t number =
        results_.diagnoses.add(std::make_shared<StoredDiagnosis>(StoredDiagnosis{diagnosis, names, load}));
    Json json{{"diagnosis", number}};
    json.update(diagnosis_json(*diagnosis, points));
    return json;
  });
}

Json Session::preview(const Request& request) {
  const auto stored = results_.diagnoses.find(request.whole("diagnosis", 0));
  if (!stored) throw Refused("this diagnosis is not kept any more");
  const Additions additions = chosen(*stored->diagnosis, request.texts("effects"));
  const std::string named = request.text("path");
  const auto file = source(named.empty() ? folder_.relative(stored->diagnosis->diagram) : named);
  const std::string experiment = folder_.path_of(stored->experiments.front());
  const size_t points = size_t(std::clamp<int64_t>(request.whole("points", 600), 10, 20'000));
  return start(request, [=](Work& work) -> Json {
    const Experiments experiments = read({experiment});
    const Improvement improved = improve(file, experiments, stored->load, additions);
    RunOptions options;
    options.interrupt = &work.job.interrupt();
    const Comparison comparison = compare_signals(
        improved.file, with_moved_ports(*experiments.front(), improved.moved), stored->load, options);
    const ComparedSignal& signal = comparison.signals.front();
    Json json = thinned_curve(picked(signal.rows, comparison.time), signal.error, points);
    json["unit"] = signal.unit, json["rmse"] = signal.rmse, json["signal"] = signal.name;
    return json;
  });
}

Json Session::add_effects(const Request& request) {
  const auto stored = results_.diagnoses.find(request.whole("diagnosis", 0));
  if (!stored) throw Refused("this diagnosis is not kept any more");
  const Additions additions = chosen(*stored->diagnosis, request.texts("effects"));
  std::string names;
  for (const AddedEffect& added : additions.effects)
    names += (names.empty() ? "" : ", ") + added.effect.title;
  const std::string path = request.required("path");
  return changed(request, [&](Document& document) {
    std::vector<std::string> paths;
    for (const std::string& experiment : stored->experiments) paths.push_back(folder_.path_of(experiment));
    const auto file = std::make_shared<SourceFile>(SourceFile{folder_.path_of(path), document.text()});
    const Improvement improved = improve(file, read(paths), stored->load, additions);
    std::map<std::string, std::string> renamed;
    for (const MovedPort& moved : improved.moved) renamed[moved.from] = moved.to.front();
    std::vector<OtherFile> others;
    for (const std::string& experiment : stored->experiments) {
      OtherFile other{experiment, folder_.read(experiment), {}};
      other.after = with_ports_renamed(experiment, other.before.value_or(""), renamed);
      if (other.before != other.after) others.push_back(std::move(other));
    }
    return document.take("add " + names, improved.file->text, std::move(others), improved.blocks);
  });
}

}  // namespace loopwright::studio
