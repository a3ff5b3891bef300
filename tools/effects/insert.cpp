#include "tools/effects/insert.h"
#include <algorithm>
#include <fmt/format.h>
#include <set>
#include "engine/diagram/expression.h"
#include "engine/json/json.h"
#include "engine/json/reader.h"
#include "tools/effects/effect_values.h"
#include "tools/effects/fragment_text.h"
#include "tools/effects/nest.h"
#include "tools/effects/setting_change.h"
#include "tools/effects/take_out.h"
#include "tools/effects/wire_reader.h"

namespace loopwright {
namespace {

using Kind = Value::Kind;
using To = Attachment::To;
using Level = Nest::Level;
using Port = Nest::Port;

class Inserter {
 public:
  Inserter(std::shared_ptr<const SourceFile> file, const InsertionSite& site, const Effect& effect,
           const std::vector<double>& fitted, const RecordSizes& sizes, Problems& problems)
      : site_(site),
        effect_(site.can_be_taken_out ? with_switch(effect) : effect),
        values_(values_of(effect, sizes, fitted)),
        fragment_(effect_, values_, site.units),
        problems_(problems),
        place_{file, 0},
        nest_(std::move(file), site, problems) {}

  std::optional<Insertion> run() {
    if (!nest_.is_readable() || !find_sum()) return {};
    find_mass();
    choose_names();
    for (const Attachment& attachment : effect_.attachments) attach(attachment);
    if (!failed_) add_force_terms();
    if (failed_) return {};
    new_parameters_.write();
    result_.text = nest_.text();
    return std::move(result_);
  }

 private:
  Problem& error(std::string message) {
    failed_ = true;
    return problems_.error(place_, "", "",
                           fmt::format("the effect \"{}\" cannot be added: {}", effect_.name, message));
  }

  std::string port_of(std::string_view role) const {
    for (const auto& [name, port] : site_.roles)
      if (name == role) return port;
    return "";
  }

  // ---- Location of the machine ----

  bool find_sum() {
    const std::string port = port_of("force");
    if (port.empty()) {
      error("the experiment names no role \"force\"").expected = "\"roles\": {\"force\": a Sum of forces}";
      return false;
    }
    const auto found = nest_.follow(nest_.top(), port);
    const Value::Member* block = found && !found->block.empty() ? found->level.block(found->block) : nullptr;
    const bool is_sum = block && type_of(*nest_.body(found->level, *block)) == "Sum";
    if (!is_sum) {
      auto& p = error(fmt::format("the role \"force\" leads to no sum of forces"));
      p.expected = "the output of a Sum that accepts more terms";
      p.found = port + (block ? ", a " + type_of(block->value) : "");
      return false;
    }
    sum_level_ = found->level, sum_ = block;
    return true;
  }

  /// The mass that the sum of forces moves.
  void find_mass() {
    const std::string sum_output = sum_->name + ".sum";
    for (const Value::Member& block : sum_level_.diagram->find("blocks")->value.members) {
      const std::string type = type_of(block.value);
      if (type != "Mass" && type != "Inertia" && type != "TwoMass") continue;
      each_wire(block.value, [&](const Value& wire) {
        if (wire.text == sum_output) mass_ = &block, mass_prefix_ = type == "TwoMass" ? "motor_" : "";
      });
    }
  }

  /// The port that carries a role's signal, as a wire in the diagram of `level`.
  std::string source_of(std::string_view role, const Level& level) {
    std::string path;
    const bool has_acceleration = mass_prefix_.empty();
    if (mass_ && (role == "position" || role == "velocity" || (role == "acceleration" && has_acceleration))) {
      const bool is_angle = role == "position" && type_of(mass_->value) == "Inertia";
      path = joined(joined(sum_level_.prefix, mass_->name),
                    mass_prefix_ + std::string(is_angle ? "angle" : role));
    } else if (const std::string port = port_of(role); !port.empty()) {
      const auto found = nest_.follow(nest_.top(), port);
      path = found ? found->path() : port;
    }
    if (level.prefix.empty() && !path.empty()) return path;
    if (path.starts_with(level.prefix + ".")) return path.substr(level.prefix.size() + 1);
    error(fmt::format("it reads the {}, which is not known there", role)).expected =
        fmt::format("a role \"{}\" of the experiment, computed in the diagram of \"{}\"", role, level.prefix);
    return "";
  }

  // ---- The effect's blocks ----

  /// Blocks that act themselves; blocks that only represent a changed parameter are not needed.
  void need(const std::string& name) {
    const Value::Member* block = effect_.blocks.find(name);
    if (!block || !needed_.insert(name).second) return;
    each_wire(block->value, [&](const Value& wire) {
      if (wire.text.find('.') != std::string::npos) need(block_of(wire.text));
    });
  }

  void choose_names() {
    for (const Attachment& a : effect_.attachments)
      if (a.to != To::parameter) need(block_of(a.from));
    std::set<std::string> used;
    for (const char* key : {"blocks", "parameters", "inputs"})
      if (const auto* list = sum_level_.diagram->find(key))
        for (const Value::Member& member : list->value.members) used.insert(member.name);
    const auto is_used = [&](const std::string& name) {
      return std::ranges::any_of(
          used, [&](const std::string& u) { return u == name || u.starts_with(name + "_"); });
    };
    base_ = effect_.name;
    for (int i = 2; is_used(base_) || used.contains(switch_of(base_)); ++i)
      base_ = fmt::format("{}_{}", effect_.name, i);
    fragment_.name(base_, needed_.size() == 1);
  }
  std::string name_of(const std::string& block) const { return fragment_.name_of(block); }

  void add_blocks(const Level& level, const Value::Member& before) {
    if (were_added_) return;
    were_added_ = true;
    FragmentText::Surroundings around;
    around.wire = [&](std::string_view role) {
      if (role == "input") return input_source_;
      return role == "position" && !measured_source_.empty() ? measured_source_ : source_of(role, level);
    };
    around.initial = [&](std::string_view name) {
      const Value::Member* start = mass_ ? mass_->value.find(name) : nullptr;
      return start ? to_json(start->value) : "";
    };
    std::string text;
    for (const Value::Member& block : effect_.blocks.members) {
      if (!needed_.contains(block.name)) continue;
      const std::string path = joined(level.prefix, name_of(block.name));
      text += member_before(level.diagram->find("blocks")->value, before, name_of(block.name),
                            fragment_.block(block, path, around, result_.settings));
      result_.blocks.push_back(path);
      uses_switch_ |= mentions_switch(block.value);
    }
    level.document->edits.insert(before.place.offset, text);
    if (uses_switch_) declare_switch(level);
  }

  /// The parameter that takes the effect out, in the diagram of its blocks.
  void declare_switch(const Level& level) {
    if (result_.taken_out_by.empty()) result_.taken_out_by = joined(level.prefix, switch_of(base_));
    new_parameters_.add(level, switch_of(base_), 1, "", effect_.title + ": 1; 0 takes it out");
  }

  // ---- Attachments ----

  void attach(const Attachment& attachment) {
    if (attachment.to == To::force) attach_to_force(attachment);
    if (attachment.to == To::input) attach_to_input(attachment);
    if (attachment.to == To::sensor) attach_to_sensor(attachment);
    if (attachment.to == To::parameter) attach_to_parameter(attachment);
  }

  std::string new_port(const std::string& from) const {
    return name_of(block_of(from)) + from.substr(from.find('.'));
  }

  void attach_to_force(const Attachment& attachment) {
    add_blocks(sum_level_, *sum_);
    force_terms_.push_back(new_port(attachment.from));
  }

  /// All at once: the sum has one list of terms, and one of signs.
  void add_force_terms() {
    if (force_terms_.empty()) return;
    TextEdits& edits = sum_level_.document->edits;
    const std::string& text = sum_level_.document->text();
    const Value::Member* in = sum_->value.find("in");
    const Value::Member* terms = in ? in->value.find("terms") : nullptr;
    if (!terms || terms->value.kind != Kind::list || terms->value.items.empty()) {
      error("the sum of forces has no list of terms").expected = "\"in\": {\"terms\": [\"motor.force\", …]}";
      return;
    }
    std::string more;
    for (const std::string& term : force_terms_) more += fmt::format(", \"{}\"", term);
    edits.insert(end_of_value(text, terms->value.items.back().place.offset), more);
    const std::string minuses(force_terms_.size(), '-');
    if (const auto* signs = sum_->value.find("signs"))
      edits.insert(end_of_value(text, signs->value.place.offset) - 1, minuses);
    else
      edits.insert(in->place.offset, fmt::format("\"signs\": \"{}{}\", ",
                                                 std::string(terms->value.items.size(), '+'), minuses));
  }

  void attach_to_input(const Attachment& attachment) {
    const std::string role = port_of("input");
    const auto found = role.empty() ? std::nullopt : nest_.follow(nest_.top(), role);
    if (!found) {
      error("the role \"input\" leads to no port").found = role.empty() ? "no role \"input\"" : role;
      return;
    }
    const Value::Member* block = found->block.empty() ? nullptr : found->level.block(found->block);
    const Value::Member* in = block ? block->value.find("in") : nullptr;
    const Value::Member* own = in ? in->value.find(found->port) : nullptr;
    std::vector<WireReader> readers;
    if (own && own->value.kind == Kind::text) {  // an input port: the wire into it
      input_source_ = own->value.text;
      readers.push_back({block, &own->value});
    } else {  // an output, or an input of the diagram: its readers
      input_source_ = block ? found->block + "." + found->port : found->port;
      readers = nearest_readers(found->level, input_source_, block_with_sum(found->level));
      result_.input_behind = joined(found->level.prefix, new_port(attachment.from));
    }
    if (readers.empty()) {
      error("nothing reads the input").found = role;
      return;
    }
    add_blocks(found->level, *readers.front().block);
    redirect(found->level, readers, new_port(attachment.from));
    for (const WireReader& reader : readers)
      result_.input_at.push_back(
          {joined(found->level.prefix, reader.block->name + "." + loopwright::port_of(reader)),
           ports_that_read_the_input(found->level)});
  }
  std::vector<std::string> ports_that_read_the_input(const Level& level) const {
    std::vector<std::string> ports;
    for (const Value::Member& block : effect_.blocks.members)
      if (needed_.contains(block.name))
        each_wire(block.value, [&](const Value& wire) {
          if (wire.text == "input")
            ports.push_back(
                joined(level.prefix, name_of(block.name) + "." + loopwright::port_of({&block, &wire})));
        });
    return ports;
  }

  /// The block of a level that contains the sum of forces: the sum itself, or a subdiagram.
  std::string block_with_sum(const Level& level) const {
    if (sum_level_.prefix == level.prefix) return sum_->name;
    const size_t skip = level.prefix.empty() ? 0 : level.prefix.size() + 1;
    return split_path(sum_level_.prefix.substr(skip)).front();
  }

  void attach_to_sensor(const Attachment& attachment) {
    const std::string role = port_of("position");
    const auto found = role.empty() ? std::nullopt : nest_.follow(nest_.top(), role);
    const Value::Member* block = found && !found->block.empty() ? found->level.block(found->block) : nullptr;
    if (!block) {
      error("the role \"position\" leads to no block").found = role.empty() ? "no role \"position\"" : role;
      return;
    }
    const std::string source = found->block + "." + found->port;
    measured_source_ = source;  // behind the errors that the measured position already has
    if (found->output && found->output_level.diagram == found->level.diagram) {
      add_blocks(found->level, *block);
      const Value* wire = &found->output->value;
      if (const auto* inner = wire->find("source")) wire = &inner->value;
      redirect(found->level, {{block, wire}}, new_port(attachment.from));
      return;
    }
    add_blocks(found->level, *block);
    redirect(found->level, readers_but_mechanics(nest_, found->level, source), new_port(attachment.from));
    result_.measured_at.push_back({role, {joined(found->level.prefix, new_port(attachment.from))}});
  }
  void attach_to_parameter(const Attachment& attachment) {
    for (const std::string& target : attachment.targets) {
      const std::vector<std::string> path = split_path(target);
      const Value::Member* block = path.size() == 2 ? block_of_type(path[0]) : nullptr;
      const Value::Member* setting = block ? block->value.find(path[1]) : nullptr;
      if (!setting) continue;
      change(*setting, attachment, path[1], joined(sum_level_.prefix, block->name));
      return;
    }
    if (attachment.is_optional) return;
    error("the machine has no block with the parameter that it changes").expected =
        fmt::format("one of {} in the diagram of the sum of forces", fmt::join(attachment.targets, ", "));
  }
  /// The mass of the machine, or a block that feeds the sum of forces.
  const Value::Member* block_of_type(const std::string& type) const {
    if (mass_ && type_of(mass_->value) == type) return mass_;
    return block_before(sum_level_, *sum_, type);
  }

  void change(const Value::Member& setting, const Attachment& attachment, const std::string& parameter,
              const std::string& block_path) {
    SettingChange change{values_.evaluate(attachment.add), "", base_ + "_" + parameter, effect_.title};
    for (const NameUse& use : names_in(attachment.add.text))
      if (const EffectParameter* p = effect_.find(use.name)) change.unit = unit_in(p->unit, site_.units);
    if (site_.can_be_taken_out) declare_switch(sum_level_), change.times = switch_of(base_);
    result_.changed.push_back(joined(block_path, parameter));
    const ChangedSetting changed = add_to_setting(sum_level_, setting.value, change, new_parameters_);
    if (changed == ChangedSetting::nothing) {
      auto& p = error(fmt::format("nothing can be added to the setting \"{}.{}\"", block_path, parameter));
      p.expected = "a number or an expression in " + change.unit, p.found = shown(setting.value);
    }
    if (changed != ChangedSetting::parameter || attachment.add.text.empty()) return;
    const std::string fitted = attachment.add.text.substr(1);
    if (effect_.find(fitted))
      result_.settings.emplace_back(fitted, joined(sum_level_.prefix, change.parameter));
  }

  const InsertionSite& site_;
  const Effect effect_;
  EffectValues values_;
  FragmentText fragment_;
  NewParameters new_parameters_;
  Problems& problems_;
  Place place_;
  Nest nest_;
  Insertion result_;
  std::vector<std::string> force_terms_;  // ports that the effect adds to the sum of forces
  bool failed_ = false, were_added_ = false, uses_switch_ = false;
  Level sum_level_;
  const Value::Member *sum_ = nullptr, *mass_ = nullptr;
  std::string mass_prefix_, base_, input_source_, measured_source_;
  std::set<std::string> needed_;
};

}  // namespace

std::optional<Insertion> insert_effect(std::shared_ptr<const SourceFile> file, const InsertionSite& site,
                                       const Effect& effect, const std::vector<double>& fitted,
                                       const RecordSizes& sizes, Problems& problems) {
  return Inserter(std::move(file), site, effect, fitted, sizes, problems).run();
}

}  // namespace loopwright
