#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>
#include "tools/design/design.h"
#include "tools/design/design_json.h"

namespace loopwright {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Json = nlohmann::ordered_json;

/// The last `parts` parts of a path as one name: "mass_position".
std::string end_of(const std::string& path, int parts) {
  size_t begin = path.size();
  for (int i = 0; i < parts && begin != 0; ++i) {
    const size_t dot = path.rfind('.', begin - 1);
    begin = dot == path.npos ? 0 : dot;
  }
  std::string name;
  for (const char c : path.substr(begin)) {
    if (std::isalnum(static_cast<unsigned char>(c)))
      name += c;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  while (name.ends_with('_')) name.pop_back();
  return name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) ? "x" + name : name;
}

Json port_json(const DesignSignal& signal) {
  Json port = {{"description", signal.name}};
  if (signal.unit) port["unit"] = to_string(*signal.unit);
  return port;
}

Json number_json(double number, const std::optional<Unit>& of, const std::optional<Unit>& per) {
  if (!of || !per) return number;
  return {{"value", number}, {"unit", to_string(*of * power(*per, -1))}};
}

/// The names of both lists, all different.
std::vector<std::string> joint_names(std::vector<DesignSignal> first,
                                     const std::vector<DesignSignal>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return port_names(first);
}

Json feedback(const Design& design) {
  const std::vector<std::string> names = joint_names(design.states, design.inputs);
  const size_t n = design.states.size();
  Json inputs, outputs, blocks;
  for (size_t i = 0; i < n; ++i) inputs[names[i]] = port_json(design.states[i]);
  for (size_t c = 0; c < design.inputs.size(); ++c) {
    const std::string& command = names[n + c];
    Json terms = Json::array();
    for (size_t i = 0; i < n; ++i) {
      const std::string block = fmt::format("{}_of_{}", command, names[i]);
      blocks[block] = {{"type", "Gain"},
                       {"gain", number_json(design.regulator.K(Index(c), Index(i)), design.inputs[c].unit,
                                            design.states[i].unit)},
                       {"in", {{"u", names[i]}}}};
      terms.push_back(block + ".y");
    }
    const std::string sum = "sum_of_" + command;
    blocks[sum] = {{"type", "Sum"}, {"signs", std::string(n, '-')}, {"in", {{"terms", terms}}}};
    outputs[command] = port_json(design.inputs[c]);
    outputs[command]["source"] = sum + ".sum";
  }
  return {{"inputs", inputs}, {"outputs", outputs}, {"blocks", blocks}};
}

Json named_units(const std::vector<std::string>& names, const std::vector<DesignSignal>& signals,
                 size_t first) {
  Json list = Json::array();
  for (size_t i = 0; i < signals.size(); ++i)
    list.push_back({{"name", names[first + i]}, {"unit", unit_text(signals[i].unit)}});
  return list;
}

Json estimator(const Design& design) {
  std::vector<DesignSignal> wires = design.inputs;
  wires.insert(wires.end(), design.outputs.begin(), design.outputs.end());
  const std::vector<std::string> inside = port_names(design.states), outside = port_names(wires);
  const size_t m = design.inputs.size(), p = design.outputs.size();
  Json block = {{"type", "Kalman"},
                {"sample_time", design.system.sample_time},
                {"states", named_units(inside, design.states, 0)},
                {"measurements", named_units(outside, design.outputs, m)},
                {"A", matrix_json(design.system.A)},
                {"C", matrix_json(design.system.C)},
                {"Q", matrix_json(design.cost.Q)},
                {"R", matrix_json(design.cost.R)},
                {"in", Json::object()}};
  if (m > 0) block["B"] = matrix_json(design.system.B);
  block["in"]["inputs"] = std::vector<std::string>(outside.begin(), outside.begin() + Index(m));
  for (size_t j = m; j < m + p; ++j) block["in"][outside[j]] = outside[j];
  Json inputs, outputs;
  for (size_t i = 0; i < m + p; ++i) inputs[outside[i]] = port_json(wires[i]);
  for (size_t i = 0; i < inside.size(); ++i) {
    outputs[inside[i]] = port_json(design.states[i]);
    outputs[inside[i]]["source"] = "filter." + inside[i];
  }
  return {{"inputs", inputs}, {"outputs", outputs}, {"blocks", {{"filter", block}}}};
}

void refuse_what_no_block_does(const Design& design) {
  Problems problems;
  const auto error = [&](const char* what, const char* hint) {
    problems.error({}, "", "", what).hint = hint;
  };
  if (!design.is_sampled())
    error("a continuous filter is not written as a diagram: the Kalman block is sampled",
          "--sample-time T, or --json for the matrices");
  else if (!design.system.D.isZero(0) || !design.cost.N.isZero(0))
    error("a known input or noise acts directly on a measurement, which the Kalman block does not have",
          "measure another port, or --json for the matrices");
  if (problems.has_errors()) throw InputError(std::move(problems));
}

}  // namespace

std::vector<std::string> port_names(const std::vector<DesignSignal>& signals) {
  constexpr int most_parts = 20;
  std::vector<std::string> names(signals.size());
  for (size_t i = 0; i < signals.size(); ++i)
    for (int parts = 1; parts <= most_parts && names[i].empty(); ++parts) {
      const std::string name = end_of(signals[i].name, parts);
      bool is_unique = true;
      for (size_t j = 0; j < signals.size(); ++j)
        is_unique = is_unique && (j == i || end_of(signals[j].name, parts) != name);
      if (is_unique || parts == most_parts) names[i] = name;
    }
  std::set<std::string> taken;
  for (std::string& name : names)
    for (int i = 2; !taken.insert(name).second; ++i) name = fmt::format("{}_{}", name, i);
  return names;
}

std::string controller_diagram(const Design& design) {
  const bool is_filter = design.kind == DesignKind::filter;
  if (is_filter) refuse_what_no_block_does(design);
  Json json = {{"loopwright", 1},
               {"title", fmt::format("{} for {}", is_filter ? "Kalman filter" : "State feedback",
                                     design.title.empty() ? "a diagram" : design.title)},
               {"description", fmt::format("Designed {} at t = {:g} s",
                                           design.is_sampled() ? fmt::format("for samples every {:g} s,",
                                                                             design.system.sample_time)
                                                               : "in continuous time",
                                           design.time)}};
  json.update(is_filter ? estimator(design) : feedback(design));
  return json.dump(1) + "\n";
}

}  // namespace loopwright
