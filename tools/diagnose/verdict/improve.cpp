#include "tools/diagnose/verdict/improve.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include "engine/json/json.h"
#include "engine/record/atomic_file.h"
#include "tools/diagnose/verdict/staircase.h"
#include "tools/diagnose/verdict/unknown_effect.h"
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

/// Empty unless a record states for itself what the effect changes.
std::string why_known(const Insertion& effect,
                      const std::vector<std::shared_ptr<const Experiment>>& experiments) {
  for (const auto& experiment : experiments)
    for (const Value::Member& setting : experiment->set)
      if (std::ranges::find(effect.changed, setting.name) != effect.changed.end())
        return fmt::format(
            "\"set\" in {} states \"{}\", which is then known; where only a part of it is known, make that a "
            "parameter of the diagram, \"=carriage + payload\", or the \"payload\" of a Mass, and set that",
            experiment->path, setting.name);
  return {};
}

}  // namespace

WhyNot attachable(const std::string& diagram, const std::vector<std::string>& paths, const LoadOptions& load,
                  const MachineUnits& units, const RecordSizes& sizes) {
  Problems problems;
  const auto experiments = load_experiments(paths, problems);
  const std::shared_ptr<const SourceFile> file = read_source(diagram, {}, problems);
  if (problems.has_errors()) throw InputError(std::move(problems));
  const InsertionSite site{roles_of(file, *experiments.front(), load), load.variants, units};
  return [=](const Effect& effect) -> std::string {
    std::vector<double> starts;
    for (const EffectParameter& p : effect.parameters)
      if (p.is_fitted) starts.push_back(range_of(p, sizes).start);
    Problems own;
    if (const auto inserted = insert_effect(file, site, effect, starts, sizes, own))
      return why_known(*inserted, experiments);
    return own.list().empty() ? "it cannot be added to the diagram" : own.list().front().message;
  };
}

Improver::Improver(const std::string& diagram, const std::vector<std::string>& experiments,
                   const LoadOptions& load, const Catalogue& catalogue, const MachineUnits& units,
                   const RecordSizes& sizes)
    : load_(load), catalogue_(catalogue), units_(units), sizes_(sizes) {
  Problems problems;
  experiments_ = load_experiments(experiments, problems);
  file_ = read_source(diagram, {}, problems);
  if (problems.has_errors()) throw InputError(std::move(problems));
}

Additions Improver::additions(std::vector<Member> members) const {
  std::ranges::stable_sort(members, {}, [](const Member& m) { return m.candidate->stage; });
  Additions result{{}, {}, {}, units_, sizes_};
  for (const Member& member : members) {
    const Candidate& candidate = *member.candidate;
    AddedEffect added{shown_name(candidate), {}, {}, {}};
    if (candidate.is_unknown) {
      const std::optional<Effect> effect = effect_of_unknown(member, sizes_);
      const std::string range = range_of_unknown(member, sizes_, units_);
      if (!effect) {
        result.not_stated.push_back("The unknown function of " + candidate.form + " is not in the diagram: " +
                                    (candidate.form == "time"
                                         ? "the clocks of the records begin at different times."
                                         : "no block can state it."));
        continue;
      }
      added.effect = *effect;
      if (!range.empty()) added.note = "The unknown function of " + candidate.form + " is " + range + ".";
    } else {
      added.effect = catalogue_.effects[size_t(&candidate - catalogue_.candidates.data())];
      if (sizes_.clocks_differ && added.effect.name == "thermal_drift")
        added.note =
            "thermal_drift begins with the first record; the clocks of the others begin at other times.";
    }
    added.fitted = fitted_values(added.effect, member);
    result.effects.push_back(std::move(added));
  }
  return result;
}

Improvement Improver::with(const std::vector<Member>& members) const {
  return improve(file_, experiments_, load_, additions(members));
}

std::vector<std::string> write(const Improvement& improved, const std::vector<std::string>& experiments,
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
