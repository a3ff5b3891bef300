#include <nlohmann/json.hpp>
#include "tools/diagnose/diagnosis.h"

namespace loopwright {

std::string to_json(const Diagnosis& d) {
  nlohmann::ordered_json json;
  json["verdict"] = name_of(d.verdict);
  json["effects"] = nlohmann::ordered_json::array();
  for (const DiagnosedEffect& effect : d.effects) {
    nlohmann::ordered_json entry{{"effect", effect.name}};
    if (!effect.form.empty()) entry["form"] = effect.form;
    if (!d.has_roles) entry["site"] = effect.site, entry["variables"] = effect.variables;
    entry["parameters"] = nlohmann::ordered_json::object();  // of a function without a name: none
    for (const DiagnosedParameter& p : effect.parameters) {
      entry["parameters"][p.name] = {{"value", p.value}, {"unit", p.unit}, {"low", p.low}, {"high", p.high}};
      if (p.times_a_turn > 0) entry["parameters"][p.name]["times_a_turn"] = p.times_a_turn;
      if (p.at_limit) entry["parameters"][p.name]["at_limit"] = true;
    }
    entry["inclusion"] = effect.inclusion;
    entry["alternatives"] = effect.alternatives;
    entry["force_rms"] = effect.force_rms, entry["optional"] = effect.is_optional;
    json["effects"].push_back(std::move(entry));
  }
  if (!d.has_roles) {
    json["moved_parameters"] = nlohmann::ordered_json::object();
    for (const MovedParameter& p : d.moved_parameters)
      json["moved_parameters"][p.name] = {
          {"stated", p.stated}, {"value", p.value}, {"unit", p.unit}, {"low", p.low}, {"high", p.high}};
    json["not_observable"] = d.not_observable;
  }
  json["other_explanations"] = nlohmann::ordered_json::array();
  for (const OtherExplanation& other : d.other_explanations)
    json["other_explanations"].push_back({{"in_place_of", other.in_place_of}, {"effects", other.effects}});
  json["steps"] = nlohmann::ordered_json::array();
  for (const DiagnosisStep& step : d.steps) {
    nlohmann::ordered_json entry{{"added", step.added}, {"force_rmse", step.force_rmse}};
    if (d.holds_out) entry["held_out_force_rmse"] = step.held_out_force_rmse;
    entry["simulation_rmse"] = step.simulation_rmse, entry["optional"] = step.is_optional;
    json["steps"].push_back(std::move(entry));
  }
  json["simulation"] = {{"horizon_s", d.simulation_horizon_s}, {"diverged", d.simulation_diverged}};
  json["error"] = {{"before", d.error_before},
                   {"after", d.error_after},
                   {"noise_floor", d.noise_floor},
                   {"unit", d.force_unit}};
  if (!d.has_roles) json["error"]["port"] = d.measured_port;
  json["remainder"]["variables"] = d.remainder_variables;
  if (d.remainder_interval)
    json["remainder"]["interval"] = {{"record", d.remainder_interval->record},
                                     {"from_s", d.remainder_interval->from_s},
                                     {"to_s", d.remainder_interval->to_s}};
  for (const RemainderShare& dependence : d.dependence)
    json["remainder"]["explained_share"][dependence.variable] = dependence.share;
  json["suggested_experiments"] = nlohmann::ordered_json::array();
  for (const SuggestedExperiment& e : d.suggested)
    json["suggested_experiments"].push_back({{"text", e.text}, {"between", {e.between, e.and_effect}}});
  json["record"] = nlohmann::ordered_json::array();
  for (const RecordFinding& f : d.findings) json["record"].push_back({{"finding", f.what}, {"cost", f.cost}});
  json["too_small"] = nlohmann::ordered_json::array();
  for (const TooSmallEffect& e : d.too_small)
    json["too_small"].push_back({{"effect", e.effect},
                                 {"force_rms", e.force_rms},
                                 {"share_of_driving_force", e.share},
                                 {"gain", e.gain}});
  json["refused"] = nlohmann::ordered_json::array();
  for (const RefusedEffect& r : d.refused) json["refused"].push_back({{"effect", r.effect}, {"why", r.why}});
  json["contradictions"] = d.contradictions;
  json["not_looked_for"] = nlohmann::ordered_json::array();
  for (const NotLookedFor& n : d.not_looked_for)
    for (const std::string& effect : n.effects)
      json["not_looked_for"].push_back({{"effect", effect}, {"why", n.why}});
  json["prediction_errors"]["rows"] = d.rows;
  json["prediction_errors"]["mean_square"] = d.mean_square;
  if (d.holds_out) json["prediction_errors"]["held_out_mean_square"] = d.held_out_mean_square;
  json["prediction_errors"]["portmanteau_40"] = d.portmanteau;
  json["noise"] = {{"white_force", d.white_force},
                   {"slow_force", d.slow_force},
                   {"slow_force_time_s", d.slow_force_time_s},
                   {"measurement", d.measurement_noise},
                   {"slow_disturbances", nlohmann::ordered_json::array()}};
  for (const SlowDisturbance& slow : d.slow_disturbances)
    json["noise"]["slow_disturbances"].push_back({{"site", slow.site},
                                                  {"size", slow.size},
                                                  {"unit", slow.unit},
                                                  {"share", slow.share},
                                                  {"time_s", slow.time_s}});
  json["diagram"] = d.improved.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(d.improved);
  json["experiment_ports"] = nlohmann::ordered_json::array();
  for (const MovedPort& moved : d.experiment_ports)
    json["experiment_ports"].push_back({{"from", moved.from}, {"to", moved.to}});
  json["improved_experiments"] = d.improved_experiments;
  json["taken_out_by"] = d.taken_out_by;
  return json.dump(2) + "\n";
}

}  // namespace loopwright
