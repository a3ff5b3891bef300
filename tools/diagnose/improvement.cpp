#include "tools/diagnose/improvement.h"
#include <algorithm>
#include "engine/diagram/in_memory.h"
#include "engine/json/json.h"
#include "tools/effects/written_number.h"
#include "tools/experiment/sensor_gains.h"

namespace loopwright {
namespace {

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

}  // namespace

RolePorts roles_of(const std::shared_ptr<const SourceFile>& diagram, const Experiment& experiment,
                   const LoadOptions& load) {
  Problems problems;
  const auto loaded = load_diagram_text(diagram, with_own_values(experiment, load), problems);
  const auto plan = loaded ? compile(*loaded, problems) : nullptr;
  if (!plan) throw InputError(std::move(problems));
  return without_sensor_gains(*plan, experiment).roles.ports;
}

namespace {

/// Terms and parameters that a diagnosis without roles found.
class TermsWriter {
 public:
  TermsWriter(Improvement& improved, const std::vector<std::shared_ptr<const Experiment>>& experiments,
              const LoadOptions& load)
      : improved_(improved), load_(load) {
    for (const auto& experiment : experiments)
      for (const RecordedSignal& signal : experiment->drives) inserted_.driven.insert(signal.port);
  }
  void add(const Term& term) {
    Problems problems;
    const InsertedTerms before = inserted_;
    if (auto text = insert_term(improved_.file, load_.variants, term, inserted_, problems))
      set_text(std::move(*text));
    else
      inserted_ = before, leave_out(problems);
  }
  void set(const std::vector<std::pair<std::string, double>>& parameters) {
    Problems of_file;
    const Value root = parse_json(improved_.file, of_file);
    TextEdits edits;
    for (const auto& [path, value] : parameters) {
      Problems problems;
      write_number(improved_.file, root, path, value, edits, problems);
      if (problems.has_errors()) leave_out(problems);
    }
    set_text(edits.apply(improved_.file->text));
  }
  void finish() {
    std::ranges::move(inserted_.blocks, std::back_inserter(improved_.blocks));
    std::ranges::move(inserted_.taken_out_by, std::back_inserter(improved_.taken_out_by));
    std::ranges::move(inserted_.moved, std::back_inserter(improved_.moved));
  }

 private:
  void leave_out(const Problems& problems) {
    improved_.left_out.push_back("Not in the diagram: " + problems.list().front().message + ".");
  }
  void set_text(std::string text) {
    improved_.file = std::make_shared<SourceFile>(SourceFile{improved_.file->name, std::move(text)});
  }

  Improvement& improved_;
  const LoadOptions& load_;
  InsertedTerms inserted_;
};

}  // namespace

Improvement improve(const std::shared_ptr<const SourceFile>& diagram,
                    const std::vector<std::shared_ptr<const Experiment>>& experiments,
                    const LoadOptions& load, const Additions& additions) {
  Improvement improved;
  improved.file = diagram;
  const bool has_roles = std::ranges::any_of(additions.effects, [](const AddedEffect& a) { return !a.term; });
  InsertionSite site{{}, load.variants, additions.units, true};
  if (has_roles) site.roles = roles_of(diagram, *experiments.front(), load);
  Problems problems;
  std::vector<MovedPort> moved;
  TermsWriter terms(improved, experiments, load);
  for (const AddedEffect& added : additions.effects) {
    if (added.term) {
      terms.add(*added.term);
      continue;
    }
    auto inserted = insert_effect(improved.file, site, added.effect, added.fitted, additions.sizes, problems);
    if (!inserted) throw InputError(std::move(problems));
    note_moves(*inserted, moved);
    move_roles(*inserted, site.roles);
    if (!inserted->taken_out_by.empty()) improved.taken_out_by.push_back(inserted->taken_out_by);
    std::ranges::move(inserted->blocks, std::back_inserter(improved.blocks));
    improved.file = std::make_shared<SourceFile>(SourceFile{diagram->name, std::move(inserted->text)});
  }
  terms.set(additions.parameters);
  terms.finish();
  for (const MovedPort& port : moved)
    if (std::ranges::any_of(experiments, [&](const auto& e) { return names(*e, port.from); }))
      improved.moved.push_back(port);
  return improved;
}

std::vector<std::string> notes_of(const Additions& written, const Additions& all) {
  std::vector<std::string> notes = written.not_stated;
  for (const AddedEffect& added : written.effects)
    if (!added.note.empty()) notes.push_back(added.note);
  const bool are_all = written.effects.size() >= all.effects.size();
  const bool differ = std::ranges::any_of(written.effects, [&](const AddedEffect& added) {
    const auto same = std::ranges::find(all.effects, added.name, &AddedEffect::name);
    return same != all.effects.end() && same->fitted != added.fitted;
  });
  if (!are_all && differ)
    notes.push_back(
        "The optional effects are not in it, and its values are those that fit best without them. With --all "
        "it has all effects, and the values above.");
  else if (!are_all)
    notes.push_back("The optional effects are not in it. With --all it has all effects.");
  return notes;
}

Experiment with_moved_ports(const Experiment& experiment, const std::vector<MovedPort>& moved) {
  Experiment result = experiment;
  for (auto* list : {&result.drives, &result.compared})
    for (RecordedSignal& signal : *list) signal.port = moved_port(signal.port, moved);
  for (auto& [role, port] : result.roles.ports) port = moved_port(port, moved);
  for (auto& column : result.data.columns) column.name = moved_port(column.name, moved);
  return result;
}

const std::string& moved_port(const std::string& port, const std::vector<MovedPort>& moved) {
  const auto found = std::ranges::find(moved, port, &MovedPort::from);
  return found == moved.end() ? port : found->to.front();
}

}  // namespace loopwright
