#include "tools/effects/insert_term.h"
#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include "engine/block/registry.h"
#include "tools/effects/nest.h"
#include "tools/effects/setting_change.h"
#include "tools/effects/take_out.h"
#include "tools/effects/wire_reader.h"

namespace loopwright {
namespace {

using Kind = Value::Kind;
using Level = Nest::Level;

/// "terms" of "terms[0]".
std::string_view name_of_port(std::string_view port) { return port.substr(0, port.find('[')); }

bool is_input_of(const std::string& type, const std::string& port) {
  const BlockType* found = find_block(type);
  return found && std::ranges::any_of(found->info.inputs,
                                      [&](const PortInfo& i) { return i.name == name_of_port(port); });
}

/// What feeds an input of a block, or one wire of its list as "terms[0]" does; null: nothing.
const Value* wire_at(const Value::Member& block, const std::string& port) {
  const Value::Member* in = block.value.find("in");
  const Value::Member* wires = in ? in->value.find(name_of_port(port)) : nullptr;
  if (!wires) return nullptr;
  const size_t bracket = port.find('[');
  if (wires->value.kind != Kind::list)
    return bracket == port.npos || port.ends_with("[0]") ? &wires->value : nullptr;
  if (bracket == port.npos) return nullptr;
  size_t index = 0;
  std::from_chars(port.data() + bracket + 1, port.data() + port.size(), index);
  return index < wires->value.items.size() ? &wires->value.items[index] : nullptr;
}

class TermInserter {
 public:
  TermInserter(std::shared_ptr<const SourceFile> file, const InsertionSite& site, const Term& term,
               InsertedTerms& inserted, Problems& problems)
      : term_(term), inserted_(inserted), problems_(problems), place_{file, 0}, nest_(file, site, problems) {}

  std::optional<std::string> run() {
    if (!nest_.is_readable()) return {};
    const auto at = nest_.follow(nest_.top(), current(inserted_.sum_at, term_.port));
    if (!at) return error("there is no such port"), std::nullopt;
    at_ = *at, level_ = at_.level;
    block_ = at_.block.empty() ? nullptr : level_.block(at_.block);
    base_ = free_name(term_.name);
    const std::vector<std::string> wires = signals();
    if (failed_) return {};
    add_term(wires);
    place_term();
    if (failed_) return {};
    level_.document->edits.insert(before().place.offset, added_);
    for (const auto& [wire, source] : redirected_) redirect(level_, {{nullptr, wire}}, source);
    parameters_.write();
    return nest_.text();
  }

 private:
  void error(const std::string& message) {
    failed_ = true;
    problems_.error(
        place_, "", "",
        fmt::format("the term \"{}\" cannot be added at \"{}\": {}", term_.name, term_.port, message));
  }
  static const std::string& current(const std::map<std::string, std::string>& list, const std::string& port) {
    const auto found = list.find(port);
    return found == list.end() ? port : found->second;
  }
  const Value& blocks() const { return level_.diagram->find("blocks")->value; }
  const Value::Member& before() const { return block_ ? *block_ : blocks().members.front(); }

  std::string free_name(const std::string& wanted) const {
    const auto is_used = [&](const std::string& name) {
      for (const char* key : {"blocks", "parameters", "inputs"})
        if (const auto* list = level_.diagram->find(key))
          for (const Value::Member& member : list->value.members)
            if (member.name == name || member.name.starts_with(name + "_") || member.name == switch_of(name))
              return true;
      return false;
    };
    std::string name = wanted;
    for (int i = 2; is_used(name); ++i) name = fmt::format("{}_{}", wanted, i);
    return name;
  }
  std::string add_block(const std::string& name, const std::string& text) {
    added_ += member_before(blocks(), before(), name, "{" + text + "}");
    inserted_.blocks.push_back(joined(level_.prefix, name));
    return name;
  }
  std::string add_sum(const std::string& name, const char* signs, const std::string& first,
                      const std::string& second) {
    return add_block(name, fmt::format(R"("type": "Sum", "signs": "{}", "in": {{"terms": ["{}", "{}"]}})",
                                       signs, first, second)) +
           ".sum";
  }

  // ---- What the term reads ----

  std::vector<std::string> signals() {
    std::vector<std::string> wires;
    for (const std::string& port : term_.reads) wires.push_back(wire_to(port));
    if (wires.size() < 2 || failed_) return wires;
    return {add_sum(base_ + "_difference", "+-", wires[0], wires[1])};
  }
  /// A wire in the diagram of the term to a port, which may be an output of a subdiagram there.
  std::string wire_to(const std::string& wanted) {
    const std::string& port = current(inserted_.signal_at, wanted);
    const auto found = nest_.follow(nest_.top(), port);
    if (found && !found->block.empty() && found->level.diagram == level_.diagram) {
      const Value::Member* block = level_.block(found->block);
      if (is_input_of(type_of(*nest_.body(level_, *block)), found->port))
        return signal_of_input(*block, found->port, wanted);
      return found->block + "." + found->port;
    }
    if (found && found->block.empty() && found->level.diagram == level_.diagram) return found->port;
    for (const Value::Member& block : blocks().members)
      if (const auto inner = nest_.inside(level_, block))
        if (const auto* outputs = inner->diagram->find("outputs"))
          for (const Value::Member& output : outputs->value.members) {
            const std::string name = block.name + "." + output.name;
            const auto behind = nest_.follow(level_, name);
            if (found && behind && behind->path() == found->path()) return name;
          }
    error(fmt::format("\"{}\" cannot be read there", wanted));
    return "";
  }
  /// What is fed to an input. If an experiment drives it, a Gain of one in front of it, which the experiment
  /// then drives in its place.
  std::string signal_of_input(const Value::Member& block, const std::string& port, const std::string& path) {
    const Value* wire = wire_at(block, port);
    if (!wire || wire->kind != Kind::text) {
      error(fmt::format("nothing is wired to \"{}\"", path));
      return "";
    }
    if (!inserted_.driven.contains(path)) return wire->text;
    const std::string tap =
        add_block(free_name(block.name + "_input"),
                  fmt::format(R"("type": "Gain", "gain": 1, "in": {{"u": "{}"}})", wire->text));
    redirected_[wire] = tap + ".y";
    inserted_.signal_at[path] = joined(level_.prefix, tap + ".y");
    inserted_.moved.push_back({path, {joined(level_.prefix, tap + ".u")}});
    return tap + ".y";
  }

  // ---- The term ----

  void add_term(const std::vector<std::string>& wires) {
    std::string in;
    if (!wires.empty()) {
      const bool is_list = term_.input.ends_with("[]");
      in = is_list ? fmt::format(R"(, "in": {{"{}": ["{}"]}})", term_.input.substr(0, term_.input.size() - 2),
                                 wires[0])
                   : fmt::format(R"(, "in": {{"{}": "{}"}})", term_.input, wires[0]);
    }
    add_block(base_, term_.settings + in);
    std::string acts = base_ + "." + term_.output;
    if (term_.is_change) acts = add_sum(base_ + "_change", "+-", acts, wires[0]);
    const std::string parameter = switch_of(base_);
    parameters_.add(level_, parameter, 1, "", term_.title + ": 1; 0 takes it out");
    inserted_.taken_out_by.push_back(joined(level_.prefix, parameter));
    share_ =
        add_block(base_ + "_share", fmt::format(R"("type": "Gain", "gain": "={}{}", "in": {{"u": "{}"}})",
                                                term_.is_subtracted ? "-" : "", parameter, acts)) +
        ".y";
  }

  void place_term() {
    const std::string type = block_ ? type_of(*nest_.body(level_, *block_)) : "";
    const bool is_new_sum = inserted_.sum_at.contains(term_.port);
    if (type == "Sum" && at_.port == "sum" && (is_new_sum || !inserted_.driven.contains(term_.port)))
      extend_sum();
    else if (is_input_of(type, at_.port))
      before_input();
    else
      after_output(block_ ? at_.block + "." + at_.port : at_.port);
  }
  void extend_sum() {
    const Value::Member* in = block_->value.find("in");
    const Value::Member* terms = in ? in->value.find("terms") : nullptr;
    if (!terms || (terms->value.kind == Kind::list && terms->value.items.empty()))
      return error("the sum has no terms");
    TextEdits& edits = level_.document->edits;
    const std::string& text = level_.document->text();
    if (terms->value.kind == Kind::list) {
      edits.insert(end_of_value(text, terms->value.items.back().place.offset),
                   fmt::format(", \"{}\"", share_));
    } else {
      const size_t at = terms->value.place.offset;
      edits.insert(at, "["), edits.insert(end_of_value(text, at), fmt::format(", \"{}\"]", share_));
    }
    if (const auto* signs = block_->value.find("signs"); signs && !signs->value.text.empty())
      edits.insert(end_of_value(text, signs->value.place.offset) - 1, "+");
  }
  void before_input() {
    const Value::Member* in = block_->value.find("in");
    const Value* wire = wire_at(*block_, at_.port);
    TextEdits& edits = level_.document->edits;
    if (!wire && in && in->value.find(name_of_port(at_.port))) return error("no single wire is there");
    if (!wire) {  // an unwired force
      const std::string member = fmt::format(R"("{}": "{}")", at_.port, share_);
      if (in && !in->value.members.empty())
        edits.insert(in->value.members.front().place.offset, member + ", ");
      else if (!in)
        edits.insert(block_->value.find("type")->place.offset, fmt::format(R"("in": {{{}}}, )", member));
      else
        edits.replace(in->value.place.offset, end_of_value(level_.document->text(), in->value.place.offset),
                      "{" + member + "}");
      return;
    }
    std::string fed = wire->text;
    if (const auto known = inserted_.signal_at.find(term_.port); known != inserted_.signal_at.end())
      fed = known->second.substr(level_.prefix.empty() ? 0 : level_.prefix.size() + 1);
    else if (inserted_.driven.contains(term_.port))
      fed = signal_of_input(*block_, at_.port, term_.port);
    if (failed_) return;
    const std::string sum = add_sum(base_ + "_sum", "++", fed, share_);
    inserted_.sum_at[term_.port] = joined(level_.prefix, sum);
    redirected_[wire] = sum;
  }
  void after_output(const std::string& source) {
    const std::string sum = add_sum(base_ + "_sum", "++", source, share_);
    inserted_.sum_at[term_.port] = joined(level_.prefix, sum);
    for (const Value::Member& block : blocks().members) {
      if (std::ranges::find(inserted_.blocks, joined(level_.prefix, block.name)) != inserted_.blocks.end())
        continue;
      each_wire(block.value, [&](const Value& wire) {
        if (wire.text == source) redirected_[&wire] = sum;
      });
    }
    if (const auto* outputs = level_.diagram->find("outputs"))
      for (const Value::Member& output : outputs->value.members) {
        const Value* wire = &output.value;
        if (const auto* inner = wire->find("source")) wire = &inner->value;
        if (wire->text == source) redirected_[wire] = sum;
      }
  }

  const Term& term_;
  InsertedTerms& inserted_;
  Problems& problems_;
  Place place_;
  Nest nest_;
  NewParameters parameters_;
  Nest::Port at_;
  Level level_;
  const Value::Member* block_ = nullptr;
  std::map<const Value*, std::string> redirected_;  // wires, and what they carry from now on
  std::string base_, share_, added_;
  bool failed_ = false;
};

}  // namespace

std::optional<std::string> insert_term(std::shared_ptr<const SourceFile> file,
                                       const std::map<std::string, std::string>& variants, const Term& term,
                                       InsertedTerms& inserted, Problems& problems) {
  InsertionSite site;
  site.variants = variants;
  return TermInserter(std::move(file), site, term, inserted, problems).run();
}

}  // namespace loopwright
