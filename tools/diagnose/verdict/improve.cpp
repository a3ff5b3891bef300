#include "tools/diagnose/verdict/improve.h"
#include <algorithm>
#include <filesystem>
#include "engine/json/json.h"
#include "engine/record/atomic_file.h"
#include "tools/diagnose/verdict/unknown_effect.h"
#include "tools/effects/nest.h"
#include "tools/experiment/sensor_gains.h"

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

bool names(const Experiment& experiment, const std::string& port) {
  const auto is_port = [&](const RecordedSignal& signal) { return signal.port == port; };
  return std::ranges::any_of(experiment.drives, is_port) ||
         std::ranges::any_of(experiment.compared, is_port) ||
         std::ranges::any_of(experiment.roles.ports, [&](const auto& role) { return role.second == port; });
}

/// Where several insertions moved ports to.
void note_moves(const Insertion& insertion, std::vector<MovedPort>& list) {
  for (const MovedPort& moved : insertion.measured_at) {  // the last error of a sensor is the outermost
    const auto earlier = std::ranges::find(list, std::vector{moved.from}, &MovedPort::to);
    if (earlier != list.end())
      earlier->to = moved.to;
    else
      list.push_back(moved);
  }
  for (const MovedPort& moved : insertion.input_at)  // the first effect of the input reads it
    if (std::ranges::find(list, moved.from, &MovedPort::from) == list.end()) list.push_back(moved);
}

/// Roles with which a further effect is inserted behind this one.
void move_roles(const Insertion& insertion, RolePorts& roles) {
  for (auto& [role, port] : roles) {
    for (const auto& [from, to] : insertion.measured_at)
      if (port == from) port = to.front();
    if (role == "input" && !insertion.input_behind.empty()) port = insertion.input_behind;
  }
}

const std::string& moved_port(const std::string& port, const std::vector<MovedPort>& moved) {
  const auto found = std::ranges::find(moved, port, &MovedPort::from);
  return found == moved.end() ? port : found->to.front();
}

/// The text of an experiment for another folder.
std::string moved_text(const std::string& path, const std::vector<MovedPort>& moved,
                       const std::string& folder, Problems& problems) {
  const auto file = read_source(path, {}, problems);
  if (!file) return {};
  const Value root = parse_json(file, problems);
  TextEdits edits;
  const auto replace = [&](size_t at, const std::string& port) {
    if (moved_port(port, moved) != port)
      edits.replace(at, end_of_value(file->text, at), "\"" + moved_port(port, moved) + "\"");
  };
  for (const char* key : {"drive", "compare"})
    if (const auto* list = root.find(key))
      for (const Value::Member& signal : list->value.members) replace(signal.place.offset, signal.name);
  if (const auto* roles = root.find("roles"))
    for (const Value::Member& role : roles->value.members) replace(role.value.place.offset, role.value.text);
  namespace fs = std::filesystem;
  if (const auto* data = root.find("data")) {
    const fs::path beside = fs::path(path).parent_path() / data->value.text;
    std::error_code code;
    if (fs::path(data->value.text).is_relative() && fs::exists(beside, code)) {
      Value text = data->value;
      text.text = fs::proximate(fs::absolute(beside), fs::absolute(folder), code).string();
      const size_t at = text.place.offset;
      edits.replace(at, end_of_value(file->text, at), to_json(text));
    }
  }
  return edits.apply(file->text);
}

/// Of the quantities themselves, where the experiment names sensors.
RolePorts roles_of(const std::string& diagram, const Experiment& experiment, const LoadOptions& load) {
  Problems problems;
  const auto loaded = load_diagram(diagram, load, problems);
  const auto plan = loaded ? compile(*loaded, problems) : nullptr;
  if (!plan) throw InputError(std::move(problems));
  return without_sensor_gains(*plan, experiment).roles.ports;
}

}  // namespace

WhyNot attachable(const std::string& diagram, const std::string& experiment_path, const LoadOptions& load,
                  const MachineUnits& units, const RecordSizes& sizes) {
  Problems problems;
  const auto experiment = load_experiment(experiment_path, problems);
  const std::shared_ptr<const SourceFile> file = read_source(diagram, {}, problems);
  if (!file || !experiment) throw InputError(std::move(problems));
  const InsertionSite site{roles_of(diagram, *experiment, load), load.variants, units};
  return [=](const Effect& effect) -> std::string {
    std::vector<double> starts;
    for (const EffectParameter& p : effect.parameters)
      if (p.is_fitted) starts.push_back(range_of(p, sizes).start);
    Problems own;
    if (insert_effect(file, site, effect, starts, sizes, own)) return {};
    return own.list().empty() ? "it cannot be added to the diagram" : own.list().front().message;
  };
}

Improver::Improver(const std::string& diagram, const std::vector<std::string>& experiments,
                   const LoadOptions& load, const Catalogue& catalogue, const MachineUnits& units,
                   const RecordSizes& sizes)
    : catalogue_(catalogue), sizes_(sizes) {
  Problems problems;
  for (const std::string& path : experiments) experiments_.push_back(load_experiment(path, problems));
  file_ = read_source(diagram, {}, problems);
  if (!file_ || std::ranges::find(experiments_, nullptr) != experiments_.end())
    throw InputError(std::move(problems));
  site_ = {roles_of(diagram, *experiments_.front(), load), load.variants, units, true};
}

ImprovedDiagram Improver::with(const std::vector<Member>& list) const {
  ImprovedDiagram improved{file_, {}, {}, {}};
  InsertionSite site = site_;
  std::vector<Member> members = list;  // in the direction of the signal
  std::ranges::stable_sort(members, {}, [](const Member& m) { return m.candidate->stage; });
  Problems problems;
  std::vector<MovedPort> moved;
  for (const Member& member : members) {
    std::optional<Effect> unknown;
    if (member.candidate->is_unknown) {
      unknown = effect_of_unknown(member, sizes_);
      const std::string range = range_of_unknown(member, sizes_, site.units);
      if (!unknown) {
        improved.notes.push_back("The unknown function of " + member.candidate->form +
                                 " is not in the diagram: no block can state it.");
        continue;
      }
      if (!range.empty())
        improved.notes.push_back("The unknown function of " + member.candidate->form + " is " + range + ".");
    }
    const Effect& effect =
        unknown ? *unknown : catalogue_.effects[size_t(member.candidate - catalogue_.candidates.data())];
    const auto inserted =
        insert_effect(improved.file, site, effect, fitted_values(effect, member), sizes_, problems);
    if (!inserted) throw InputError(std::move(problems));
    note_moves(*inserted, moved);
    move_roles(*inserted, site.roles);
    if (!inserted->taken_out_by.empty()) improved.taken_out_by.push_back(inserted->taken_out_by);
    improved.file = std::make_shared<SourceFile>(SourceFile{file_->name, inserted->text});
  }
  for (const MovedPort& port : moved)
    if (std::ranges::any_of(experiments_, [&](const auto& e) { return names(*e, port.from); }))
      improved.moved.push_back(port);
  return improved;
}

Experiment with_moved_ports(const Experiment& experiment, const std::vector<MovedPort>& moved) {
  Experiment result = experiment;
  for (auto* list : {&result.drives, &result.compared})
    for (RecordedSignal& signal : *list) signal.port = moved_port(signal.port, moved);
  for (auto& [role, port] : result.roles.ports) port = moved_port(port, moved);
  for (loopwright::Column& column : result.data.columns) column.name = moved_port(column.name, moved);
  return result;
}

std::vector<std::string> write(const ImprovedDiagram& improved, const std::vector<std::string>& experiments,
                               const std::string& target) {
  namespace fs = std::filesystem;
  const fs::path path(target);
  const std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
  Problems problems;
  std::vector<std::pair<std::string, std::string>> others;
  for (const std::string& experiment : experiments) {
    if (improved.moved.empty()) break;
    std::string name = path.stem().string() + "." + fs::path(experiment).filename().string();
    const auto is_taken = [&](const auto& other) { return fs::path(other.first).filename() == name; };
    if (std::ranges::any_of(others, is_taken))  // of the same name in another folder
      name = path.stem().string() + "." + std::to_string(others.size() + 1) + "." +
             fs::path(experiment).filename().string();
    others.emplace_back((fs::path(folder) / name).string(),
                        moved_text(experiment, improved.moved, folder, problems));
  }
  if (problems.has_errors()) throw InputError(std::move(problems));
  write_file(target, moved_to_folder(*improved.file, folder));
  std::vector<std::string> written;
  for (const auto& [name, text] : others) write_file(name, text), written.push_back(name);
  return written;
}

}  // namespace loopwright::diagnosis
