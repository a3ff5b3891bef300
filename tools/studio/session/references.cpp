#include "tools/studio/session/references.h"
#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <span>
#include "engine/json/reader.h"
#include "tools/studio/session/experiment_text.h"
#include "tools/studio/session/member_change.h"
#include "tools/studio/session/renamed_sources.h"

namespace loopwright::studio {
namespace {

using Kind = Value::Kind;

bool is_below(std::string_view path, std::string_view block) {
  return path.size() > block.size() && path.starts_with(block) && path[block.size()] == '.';
}

std::string parent_of(const std::string& path) {
  const size_t dot = path.rfind('.');
  return dot == path.npos ? "" : path.substr(0, dot);
}

bool is_expression(const Value& value) { return value.kind == Kind::text && value.text.starts_with('='); }

/// In a sweep or an experiment.
class FileChanges {
 public:
  FileChanges(const std::vector<Renaming>& renamings, std::vector<std::string>& conflicts)
      : renamings_(renamings), names_(renamings), conflicts_(conflicts) {}

  TextChanges take_experiment(const Value& experiment) {
    follow_set(experiment);
    std::ranges::move(ports_renamed(experiment, [&](const std::string& port) { return names_.signal(port); }),
                      std::back_inserter(changes_));
    return std::move(changes_);
  }
  TextChanges take_sweep(const Value& sweep) {
    follow_set(sweep);
    for (const Value::Member& choice : members_of(sweep, "variants"))
      set_name(choice, names_.block(choice.name));
    for (const Value::Member& axis : members_of(sweep, "axes")) set_name(axis, name_of_axis(axis));
    if (const Value::Member* paired = sweep.find("paired"))
      for (const Value& group : paired->value.items)
        for (const Value& axis : group.items) set_text(axis, name_of_paired(sweep, axis.text));
    for (const Value::Member& metric : members_of(sweep, "metrics"))
      for (const Value::Member& part : metric.value.members)
        if (part.name != "unit") set_text(part.value, names_.metric(part.value.text));
    return std::move(changes_);
  }

 private:
  void follow_set(const Value& file) {
    for (const Value::Member& entry : members_of(file, "set")) {
      set_name(entry, name_of_setting(entry.name));
      follow_value(entry);
    }
  }
  static std::span<const Value::Member> members_of(const Value& file, std::string_view name) {
    const Value::Member* list = file.find(name);
    return list ? std::span<const Value::Member>(list->value.members) : std::span<const Value::Member>();
  }
  std::string name_of_setting(const std::string& path) {
    std::string conflict;
    std::string name = names_.setting(path, conflict);
    if (!conflict.empty() && std::ranges::find(conflicts_, conflict) == conflicts_.end())
      conflicts_.push_back(conflict);
    return name;
  }
  std::string name_of_axis(const Value::Member& axis) {
    return axis.value.find("variants") ? names_.block(axis.name) : name_of_setting(axis.name);
  }
  std::string name_of_paired(const Value& sweep, const std::string& name) {
    for (const Value::Member& axis : members_of(sweep, "axes"))
      if (axis.name == name) return name_of_axis(axis);
    return name;
  }
  /// The expression of a setting uses parameters of the diagram in which the setting stands.
  void follow_value(const Value::Member& entry) {
    if (!is_expression(entry.value)) return;
    for (const Renaming& renaming : renamings_) {
      if (renaming.kind == Renaming::Kind::block) {
        if (is_below(entry.name, renaming.from) && parent_of(renaming.from) != parent_of(renaming.to))
          conflicts_.push_back(fmt::format(
              "sets \"{}\" to an expression, whose parameters may not be there inside", entry.name));
        continue;
      }
      const std::string level = parent_of(renaming.from);
      if (!level.empty() && !is_below(entry.name, level)) continue;
      const std::string inside = level.empty() ? entry.name : entry.name.substr(level.size() + 1);
      if (!renaming.in_scope.contains(inside.substr(0, inside.find('.')))) continue;
      const std::string from = renaming.from.substr(level.empty() ? 0 : level.size() + 1),
                        to = renaming.to.substr(level.empty() ? 0 : level.size() + 1);
      std::ranges::move(uses_of_parameter(entry.value, from, to), std::back_inserter(changes_));
    }
  }
  void set_name(const Value::Member& member, const std::string& to) {
    if (to != member.name) changes_.push_back(renamed_member(member, to));
  }
  void set_text(const Value& text, const std::string& to) {
    if (text.kind == Kind::text && to != text.text) changes_.push_back(replaced(text, in_quotes(to)));
  }

  const std::vector<Renaming>& renamings_;
  const NewNames names_;
  std::vector<std::string>& conflicts_;
  TextChanges changes_;
};

}  // namespace

std::vector<Renaming> seen_from(const std::string& path, const std::vector<Renaming>& renamings) {
  std::vector<Renaming> seen = renamings;
  if (path.empty()) return seen;
  for (Renaming& renaming : seen)
    renaming.from = joined(path, renaming.from), renaming.to = joined(path, renaming.to);
  return seen;
}

std::string NewNames::signal(std::string name) const {
  for (const Renaming& renaming : renamings_)
    if (renaming.kind == Renaming::Kind::block && is_below(name, renaming.from))
      name = renaming.to + name.substr(renaming.from.size());
  return name;
}

std::string NewNames::metric(const std::string& text) const {
  if (!text.starts_with('=')) return signal(text);
  const auto is_part = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' || c == '[' || c == ']';
  };
  std::string changed;
  for (size_t at = 0; at < text.size();) {
    size_t end = at;
    while (end < text.size() && is_part(text[end])) ++end;
    changed += signal(text.substr(at, end - at));
    if (end < text.size()) changed += text[end];
    at = end + 1;
  }
  return changed;
}

std::string NewNames::block(std::string path) const {
  for (const Renaming& renaming : renamings_) {
    if (renaming.kind != Renaming::Kind::block) continue;
    if (path == renaming.from || is_below(path, renaming.from))
      path = renaming.to + path.substr(renaming.from.size());
  }
  return path;
}

/// As `--set` finds its place: a path that goes on behind a name means the block of that name if there is
/// one, otherwise the parameter; the outermost "solver" means the solver.
std::string NewNames::setting(std::string path, std::string& conflict) const {
  for (const Renaming& renaming : renamings_) {
    const bool is_whole = path == renaming.from, goes_on = is_below(path, renaming.from);
    if (!is_whole && !goes_on) continue;
    const bool is_block = renaming.kind == Renaming::Kind::block;
    if (is_whole ? is_block && renaming.has_namesake : !is_block && renaming.has_namesake) continue;
    if (goes_on && is_block && renaming.from == "solver") continue;
    if (goes_on && (is_block ? renaming.to == "solver" : renaming.meets_namesake)) {
      conflict = fmt::format("names \"{}\", which under the name \"{}\" would mean something else", path,
                             renaming.to + path.substr(renaming.from.size()));
      continue;
    }
    path = renaming.to + path.substr(renaming.from.size());
  }
  return path;
}

TextChanges renamed_in_sweep(const Value& sweep, const std::vector<Renaming>& renamings,
                             std::vector<std::string>& conflicts) {
  return FileChanges(renamings, conflicts).take_sweep(sweep);
}

TextChanges renamed_in_experiment(const Value& experiment, const std::vector<Renaming>& renamings,
                                  std::vector<std::string>& conflicts) {
  return FileChanges(renamings, conflicts).take_experiment(experiment);
}

TextChanges renamed_in_level(const Value& diagram, const std::vector<Renaming>& renamings) {
  const NewNames names(renamings);
  TextChanges changes;
  each_source(diagram, [&](const Value& source) {
    if (const std::string to = names.signal(source.text); to != source.text)
      changes.push_back(replaced(source, in_quotes(to)));
  });
  return changes;
}

}  // namespace loopwright::studio
