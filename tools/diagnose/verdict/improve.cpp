#include "tools/diagnose/verdict/improve.h"
#include <algorithm>
#include <filesystem>
#include "engine/json/json.h"
#include "engine/record/atomic_file.h"
#include "tools/experiment/experiment.h"
#include "tools/effects/nest.h"

namespace loopwright::diagnosis {
namespace {

/// The effect's fitted parameters in the order of its file.
std::vector<double> fitted_values(const Effect& effect, const Member& member) {
  std::vector<double> values;
  size_t linear = 0, nonlinear = 0;
  for (const EffectParameter& p : effect.parameters)
    if (p.is_fitted) values.push_back(p.is_linear ? member.linear[linear++] : member.nonlinear[nonlinear++]);
  return values;
}

/// Whether the experiment drives a port or names it in its roles.
bool is_input_of(const Experiment& experiment, const std::string& port) {
  return std::ranges::any_of(experiment.drives, [&](const RecordedSignal& d) { return d.port == port; }) ||
         std::ranges::any_of(experiment.roles.ports, [&](const auto& role) { return role.second == port; });
}

using Experiments = std::vector<std::shared_ptr<const Experiment>>;

/// Ports of the experiments that several insertions moved.
class MovedPorts {
 public:
  explicit MovedPorts(const Experiments& experiments) : experiments_(experiments) {}

  void add(const Insertion& insertion) {
    for (const MovedPort& moved : insertion.measured_at) {  // the last error of a sensor is the outermost
      const auto earlier = std::ranges::find(list_, std::vector{moved.from}, &MovedPort::to);
      if (earlier != list_.end())
        earlier->to = moved.to;
      else
        list_.push_back(moved);
    }
    for (const MovedPort& moved : insertion.input_at)  // the first effect of the input reads it
      if (is_named(moved.from) && std::ranges::find(list_, moved.from, &MovedPort::from) == list_.end())
        list_.push_back(moved);
  }
  const std::vector<MovedPort>& list() const { return list_; }

 private:
  bool is_named(const std::string& port) const {
    return std::ranges::any_of(experiments_, [&](const auto& e) { return is_input_of(*e, port); });
  }

  const Experiments& experiments_;
  std::vector<MovedPort> list_;
};

}  // namespace

WhyNot attachable(const std::string& diagram, const std::string& experiment_path, const LoadOptions& load,
                  const MachineUnits& units, const RecordSizes& sizes) {
  Problems problems;
  const auto experiment = load_experiment(experiment_path, problems);
  const std::shared_ptr<const SourceFile> file = read_source(diagram, {}, problems);
  if (!file || !experiment) throw InputError(std::move(problems));
  const InsertionSite site{experiment->roles.ports, load.variants, units};
  return [=](const Effect& effect) -> std::string {
    std::vector<double> starts;
    for (const EffectParameter& p : effect.parameters)
      if (p.is_fitted) starts.push_back(range_of(p, sizes).start);
    Problems own;
    if (insert_effect(file, site, effect, starts, sizes, own)) return {};
    return own.list().empty() ? "it cannot be added to the diagram" : own.list().front().message;
  };
}

Additions additions(const Catalogue& catalogue, const Estimate& estimate, const MachineUnits& units,
                    const RecordSizes& sizes) {
  Additions result{{}, units, sizes};
  for (const Member& member : estimate.members) {
    if (member.candidate->is_unknown) continue;
    const Effect& effect = catalogue.effects[size_t(member.candidate - catalogue.candidates.data())];
    result.effects.push_back({effect, fitted_values(effect, member), int(member.candidate->stage)});
  }
  std::ranges::stable_sort(result.effects, {}, &AddedEffect::stage);
  return result;
}

std::vector<MovedPort> write_improved(const std::string& diagram, const std::vector<std::string>& paths,
                                      const LoadOptions& load, const Additions& additions,
                                      const std::string& target) {
  Problems problems;
  Experiments experiments;
  for (const std::string& path : paths) experiments.push_back(load_experiment(path, problems));
  const auto file = read_source(diagram, {}, problems);
  if (!file || std::ranges::find(experiments, nullptr) != experiments.end())
    throw InputError(std::move(problems));
  const Improvement improved = improve(file, experiments, load.variants, additions);
  const std::string folder = std::filesystem::path(target).parent_path().string();
  write_file(target, moved_to_folder({diagram, improved.text}, folder.empty() ? "." : folder));
  return improved.ports;
}

}  // namespace loopwright::diagnosis

namespace loopwright {

Improvement improve(std::shared_ptr<const SourceFile> file,
                    const std::vector<std::shared_ptr<const Experiment>>& experiments,
                    const std::map<std::string, std::string>& variants, const Additions& additions,
                    const std::string& input) {
  Problems problems;
  InsertionSite site{experiments.front()->roles.ports, variants, additions.units};
  const auto set_input = [&](const std::string& port) {
    for (auto& [role, own] : site.roles)
      if (role == "input" && !port.empty()) own = port;
  };
  set_input(input);
  diagnosis::MovedPorts moved_ports(experiments);
  Improvement result{file->text, {}, {}, input};
  for (const AddedEffect& added : additions.effects) {
    auto inserted = insert_effect(file, site, added.effect, added.fitted, additions.sizes, problems);
    if (!inserted) throw InputError(std::move(problems));
    moved_ports.add(*inserted);
    for (auto& [role, port] : site.roles)
      for (const auto& [from, to] : inserted->measured_at)
        if (port == from) port = to.front();
    set_input(inserted->input_behind);
    if (!inserted->input_behind.empty()) result.input = inserted->input_behind;
    std::ranges::move(inserted->blocks, std::back_inserter(result.blocks));
    file = std::make_shared<SourceFile>(SourceFile{file->name, std::move(inserted->text)});
  }
  result.text = file->text, result.ports = moved_ports.list();
  return result;
}

}  // namespace loopwright
