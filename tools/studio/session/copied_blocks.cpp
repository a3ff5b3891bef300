#include "tools/studio/session/copied_blocks.h"
#include <fmt/format.h>
#include <algorithm>
#include <map>
#include "engine/json/reader.h"
#include "tools/studio/session/intent.h"
#include "tools/studio/session/member_change.h"
#include "tools/studio/session/written_wires.h"

namespace loopwright::studio {
namespace {

using Kind = Value::Kind;
constexpr std::string_view copied_key = "loopwright_blocks";

std::string first_of(const std::string& wire) { return wire.substr(0, wire.find('.')); }

/// The text of a block in which wires among the copies have their new names.
class Rewiring {
 public:
  Rewiring(const Level& level, const std::map<std::string, std::string>& names)
      : level_(level), names_(names) {}

  std::string text(const Value& block) const {
    TextChanges changes;
    const auto in = std::ranges::find(block.members, "in", &Value::Member::name);
    if (in != block.members.end() && in->value.kind == Kind::object) {
      std::vector<bool> gone;
      for (const Value::Member& port : in->value.members) gone.push_back(!rewire(port.value, changes));
      if (!gone.empty() && std::ranges::find(gone, false) == gone.end())
        changes = {without_member(block, size_t(in - block.members.begin()))};
      else if (std::ranges::find(gone, true) != gone.end())
        std::ranges::move(without_entries(in->value, gone), std::back_inserter(changes));
    }
    for (const std::string_view condition_key : condition_keys)  // one that leads nowhere shows as a problem
      if (const auto condition = std::ranges::find(block.members, condition_key, &Value::Member::name);
          condition != block.members.end())
        rename(condition->value, changes);
    std::ranges::sort(changes, {}, &TextChange::from);
    const size_t begin = block.place.offset;
    for (TextChange& change : changes) change.from -= begin, change.to -= begin;
    return applied(source_of(block), changes);
  }

 private:
  /// False if no wire of an input leads anywhere.
  bool rewire(const Value& wires, TextChanges& changes) const {
    if (wires.kind == Kind::text) {
      if (!leads_somewhere(wires.text)) return false;
      rename(wires, changes);
      return true;
    }
    // A list is kept as long as one wire leads somewhere: the others show as problems, with their signs.
    const bool some =
        std::ranges::any_of(wires.items, [&](const Value& w) { return leads_somewhere(w.text); });
    if (some)
      for (const Value& wire : wires.items) rename(wire, changes);
    return some;
  }
  bool leads_somewhere(const std::string& wire) const {
    if (names_.contains(first_of(wire)) && wire.find('.') != wire.npos) return true;
    const Value::Member* inputs = level_.diagram->find("inputs");
    return wire.find('.') == wire.npos ? inputs && inputs->value.find(wire)
                                       : level_.block(first_of(wire)) != nullptr;
  }
  void rename(const Value& wire, TextChanges& changes) const {
    const auto name = names_.find(first_of(wire.text));
    if (wire.kind != Kind::text || name == names_.end() || wire.text.find('.') == std::string::npos) return;
    changes.push_back(replaced(wire, in_quotes(name->second + wire.text.substr(wire.text.find('.')))));
  }

  const Level& level_;
  const std::map<std::string, std::string>& names_;
};

}  // namespace

std::string copied_blocks(const Level& level, const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names)
    text += fmt::format("{}\n  {}: {}", text.empty() ? "" : ",", in_quotes(name),
                        source_of(required_block(level, name).value));
  return fmt::format("{{{}: {{{}\n}}}}", in_quotes(copied_key), text);
}

std::vector<CopiedBlock> renamed_copies(const std::string& text, const Level& level) {
  const ParsedText parsed("clipboard", text);
  const Value::Member* blocks = parsed.is_object() ? parsed.root.find(copied_key) : nullptr;
  if (!blocks || blocks->value.kind != Kind::object) throw Refused("the clipboard has no blocks");
  std::map<std::string, std::string> names;
  std::vector<std::string> taken;
  for (const Value::Member& block : blocks->value.members) {
    if (!is_name(block.name) || block.value.kind != Kind::object)
      throw Refused(fmt::format("\"{}\" on the clipboard is no block", block.name));
    std::string name = free_name(level, block.name);
    while (std::ranges::find(taken, name) != taken.end()) name = free_name(level, name + "_2");
    taken.push_back(name);
    names.emplace(block.name, name);
  }
  const Rewiring rewiring(level, names);
  std::vector<CopiedBlock> copies;
  for (const Value::Member& block : blocks->value.members)
    copies.push_back({names.at(block.name), rewiring.text(block.value)});
  return copies;
}

}  // namespace loopwright::studio
