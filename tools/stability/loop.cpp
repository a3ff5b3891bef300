#include "tools/stability/loop.h"
#include <fmt/format.h>
#include <algorithm>
#include <map>
#include "blocks/learning/model_file.h"
#include "engine/json/reader.h"
#include "models/gp/table.h"

namespace loopwright {
namespace {

/// The single block of a type, or of its continuous counterpart; a problem if there are several.
std::string only_block(const Plan& plan, std::string_view type, Problems& problems) {
  std::string found;
  for (const Plan::Block& block : plan.blocks) {
    if (block.type->info.type != type && block.type->info.type != fmt::format("Continuous{}", type)) continue;
    if (!found.empty())
      problems
          .error(block.place, "", block.path,
                 fmt::format("a second block of type {} beside \"{}\"", type, found))
          .expected = "one loop with one of each kind";
    found = block.path;
  }
  return found;
}

/// The block that computes what input `port` of a block reads.
const Plan::Block* feeder(const Plan& plan, const std::string& block, std::string_view port) {
  for (const Plan::Block& candidate : plan.blocks) {
    if (candidate.path != block) continue;
    for (size_t i = 0; i < candidate.inputs.size(); ++i)
      if (candidate.type->info.inputs[i].name == port && !candidate.inputs[i].empty())
        if (const int source = plan.source_of(candidate.inputs[i][0]).first; source >= 0)
          return &plan.blocks[size_t(source)];
  }
  return nullptr;
}

std::string outermost(const std::string& path) { return path.substr(0, path.find('.')); }

/// The input of the outermost block with the most states, except controllers.
std::string plant_input(const Plan& plan, const Diagram& diagram, const LoopRoles& roles,
                        Problems& problems) {
  std::map<std::string, int> states;
  for (const Plan::Block& block : plan.blocks) states[outermost(block.path)] += block.states;
  for (const std::string& controller : {roles.observer, roles.feedback, roles.learned})
    states.erase(outermost(controller));
  const auto most = std::ranges::max_element(states, {}, [](const auto& entry) { return entry.second; });
  const auto plant =
      std::ranges::find(diagram.blocks, most == states.end() ? "" : most->first, &BlockEntry::name);
  if (plant == diagram.blocks.end() || most->second == 0) {
    problems.error({}, "", "", "the diagram has no continuous plant").expected = "a block with states";
    return "";
  }
  if (plant->in.size() == 1 && plant->in[0].wires.size() == 1) return plant->name + "." + plant->in[0].port;
  auto& problem = problems.error(plant->place, plant->place.pointer(), plant->name,
                                 "the plant has several inputs: which one is the command?");
  for (const PortWires& port : plant->in)
    problem.expected += (problem.expected.empty() ? "" : ", ") + plant->name + "." + port.port;
  problem.hint = "--disturbance " + plant->name + ".PORT";
  return "";
}

const BlockEntry* find_entry(const Diagram& diagram, const std::string& path) {
  const size_t dot = path.find('.');
  for (const BlockEntry& entry : diagram.blocks) {
    if (entry.name != path.substr(0, dot)) continue;
    if (dot == path.npos) return &entry;
    return entry.subdiagram ? find_entry(*entry.subdiagram, path.substr(dot + 1)) : nullptr;
  }
  return nullptr;
}

}  // namespace

LoopRoles find_roles(const Plan& plan, const Diagram& diagram, const std::string& disturbance,
                     Problems& problems) {
  LoopRoles roles;
  roles.observer = only_block(plan, "DisturbanceObserver", problems);
  roles.feedback = only_block(plan, "PdController", problems);
  // Besides the compensating block, other blocks may read a model.
  for (const Plan::Block& block : plan.blocks)
    if (block.type->info.type == "CompensationFilter")
      if (const Plan::Block* source = feeder(plan, block.path, "prediction");
          source && source->type->info.type == "Gpr")
        roles.weighting = block.path, roles.learned = source->path;
  if (roles.learned.empty()) roles.learned = only_block(plan, "Gpr", problems);
  roles.disturbance = disturbance.empty() ? plant_input(plan, diagram, roles, problems) : disturbance;
  if (!roles.learned.empty()) {
    const Plan::Block* velocity = feeder(plan, roles.learned, "velocity");
    if (velocity && velocity->type->info.type == "VelocityEstimator")
      roles.velocity_estimator = velocity->path;
  }
  if (!roles.feedback.empty())
    roles.position = roles.feedback + ".measured";
  else if (!roles.observer.empty())
    roles.position = roles.observer + ".measured";
  else if (!roles.learned.empty())
    roles.position = roles.learned + ".position";
  else
    problems.error({}, "", "", "there is no loop to judge").expected =
        "a block of type PdController, DisturbanceObserver or Gpr that reads the position";
  return roles;
}

LearnedFunction read_learned(const Diagram& diagram, const std::string& block, Problems& problems) {
  LearnedFunction function;
  const BlockEntry* entry = find_entry(diagram, block);
  const Value::Member* file = entry ? entry->settings.find("model") : nullptr;
  if (!file) return function;
  const LearnedModel learned =
      read_model(resolve_relative(file->value.place, file->value.text), file->value.place, problems);
  if (problems.has_errors()) return function;
  const gp::SlopeBounds bounds = gp::slope_bounds(gp::Posterior(learned.model));
  function.by_position = bounds.by_position, function.by_velocity = bounds.by_velocity;
  function.greatest = bounds.mean;
  if (const Value::Member* lead = entry->settings.find("lead")) function.lead = lead->value.number;
  const Value::Member* untrained = entry->settings.find("untrained");
  function.holds_beyond_training = !untrained || untrained->value.text != "posterior";
  return function;
}

}  // namespace loopwright
