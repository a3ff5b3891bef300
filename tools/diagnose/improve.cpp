#include "tools/diagnose/improve.h"
#include <algorithm>
#include <filesystem>
#include "engine/json/json.h"
#include "engine/record/atomic_file.h"
#include "tools/compare/experiment.h"
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

std::string write_improved(const std::string& diagram, const std::string& experiment_path,
                           const LoadOptions& load, const Catalogue& catalogue, const Estimate& estimate,
                           const MachineUnits& units, const RecordSizes& sizes, const std::string& target) {
  Problems problems;
  const auto experiment = load_experiment(experiment_path, problems);
  auto file = read_source(diagram, {}, problems);
  if (!file || !experiment) throw InputError(std::move(problems));
  InsertionSite site{experiment->roles.ports, load.variants, units};
  std::vector<Member> members = estimate.members;  // in the direction of the signal
  std::ranges::stable_sort(members, {}, [](const Member& m) { return m.candidate->stage; });
  for (const Member& member : members) {
    if (member.candidate->is_unknown) continue;
    const Effect& effect = catalogue.effects[size_t(member.candidate - catalogue.candidates.data())];
    const auto inserted = insert_effect(file, site, effect, fitted_values(effect, member), sizes, problems);
    if (!inserted) throw InputError(std::move(problems));
    for (auto& [role, port] : site.roles)
      for (const auto& [from, to] : inserted->moved_ports)
        if (port == from) port = to;
    if (!inserted->input_behind.empty())
      for (auto& [role, port] : site.roles)
        if (role == "input") port = inserted->input_behind;
    file = std::make_shared<SourceFile>(SourceFile{diagram, inserted->text});
  }
  const std::string folder = std::filesystem::path(target).parent_path().string();
  write_file(target, moved_to_folder(*file, folder.empty() ? "." : folder));
  return target;
}

}  // namespace loopwright::diagnosis
