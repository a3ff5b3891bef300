/// Intents that add, remove and copy blocks.
#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <set>
#include "engine/block/registry.h"
#include "engine/json/json.h"
#include "engine/json/reader.h"
#include "engine/record/installation.h"
#include "tools/studio/session/copied_blocks.h"
#include "tools/studio/session/intent.h"
#include "tools/studio/session/member_change.h"
#include "tools/studio/session/setting_text.h"

namespace loopwright::studio {
namespace {

using Kind = Value::Kind;

/// "MotionProfile" → "motion_profile".
std::string name_of_type(const std::string& type) {
  std::string name;
  for (size_t i = 0; i < type.size(); ++i) {
    const auto c = static_cast<unsigned char>(type[i]);
    const bool begins_word =
        i > 0 && std::isupper(c) && !std::isupper(static_cast<unsigned char>(type[i - 1]));
    if (begins_word) name += '_';
    name += char(std::tolower(c));
  }
  return is_name(name) ? name : "block";
}

/// The settings of the block in the example of its type.
const Value* block_in_example(const ParsedText& example, const std::string& type) {
  const Value::Member* blocks = example.is_object() ? example.root.find("blocks") : nullptr;
  if (!blocks) return nullptr;
  for (const Value::Member& member : blocks->value.members)
    if (text_in(member.value, "type") == type) return &member.value;
  return nullptr;
}

ParsedText example_of(const BlockInfo& info) {
  const size_t name = info.source.rfind('/') + 1;
  const std::string file = info.source.substr(name, info.source.rfind('.') - name) + ".json";
  Problems problems;
  const auto source = read_source(shared_file("diagrams/examples/" + file), {}, problems);
  return ParsedText(file, source ? source->text : "{}");
}

/// A value that a required parameter accepts: that of the example unless it refers to the rest of it.
std::string value_that_fits(const ParameterInfo& parameter, const Value* example) {
  const Value::Member* shown = example ? example->find(parameter.name) : nullptr;
  const bool is_own = shown && shown->value.kind != Kind::text &&
                      source_of(shown->value).find("\"=") == std::string_view::npos;
  if (shown && (is_own || parameter.kind == ParameterKind::text || parameter.kind == ParameterKind::choice))
    return std::string(source_of(shown->value));
  switch (parameter.kind) {
    case ParameterKind::number:
    case ParameterKind::whole:
      return fmt::format("{}", std::clamp(1.0, parameter.low, parameter.high));
    case ParameterKind::flag:
      return "false";
    case ParameterKind::choice:
      return in_quotes(parameter.choices.empty() ? "" : parameter.choices.front());
    case ParameterKind::list:
      return "[1]";
    case ParameterKind::object:
    case ParameterKind::by_name:
      return "{}";
    case ParameterKind::text:
    case ParameterKind::file:
      break;
  }
  return "\"\"";
}

/// The shortest sample time of a level as it is written; a millisecond if there is none.
std::string usual_sample_time(const Level& level) {
  for (const Value::Member& block : level.blocks().members)
    if (const Value::Member* time = block.value.find("sample_time"))
      return std::string(source_of(time->value));
  return "0.001";
}

std::string new_block(const BlockType& type, const Value& intent, const Level& level) {
  const BlockInfo& info = type.info;
  const Value::Member* given = intent.find("settings");
  std::string text = fmt::format("{{\"type\": {}", in_quotes(info.type));
  const auto typed = [&](std::string_view name, const ParameterInfo* parameter) -> std::string {
    const Value::Member* member =
        given && given->value.kind == Kind::object ? given->value.find(name) : nullptr;
    if (!member) return "";
    return member->value.kind == Kind::text ? json_of_typed(member->value.text, parameter)
                                            : to_json(member->value);
  };
  std::string sample_time = typed("sample_time", nullptr);
  if (sample_time.empty() && info.is_sampled) sample_time = usual_sample_time(level);
  if (!sample_time.empty()) text += ", \"sample_time\": " + sample_time;
  const ParsedText example = example_of(info);
  const Value* shown = block_in_example(example, info.type);
  for (const ParameterInfo& parameter : info.parameters) {
    std::string value = typed(parameter.name, &parameter);
    if (value.empty() && !parameter.has_default) value = value_that_fits(parameter, shown);
    if (!value.empty()) text += fmt::format(", {}: {}", in_quotes(parameter.name), value);
  }
  if (const Value::Member* in = intent.find("in");
      in && in->value.kind == Kind::object && in->value.members.size())
    text += ", \"in\": " + to_json(in->value);
  return text + "}";
}

void place(const Value& value, const std::string& path, IntentEffects& effects) {
  if (value.kind == Kind::list && value.items.size() == 2)
    effects.positions.push_back({path, std::pair(value.items[0].number, value.items[1].number)});
}

/// The change that adds a block to a level, which may have none yet.
TextChange with_block(const Level& level, const std::string& name, const std::string& block) {
  const Value::Member* blocks = level.diagram->find("blocks");
  if (!blocks)
    return with_top_member(*level.diagram, "blocks", fmt::format("{{{}: {}}}", in_quotes(name), block));
  return with_member(blocks->value, name, block, "    ");
}

void add_block(const Value& intent, const IntentContext& context, Draft& draft, IntentEffects& effects) {
  const Level level = draft.level(context.inside);
  const std::string type_name = required_text(intent, "type");
  const BlockType* type = find_block(type_name);
  if (!type)
    throw Refused(fmt::format("there is no block type \"{}\"; {}", type_name, block_type_hint(type_name)));
  std::string name(text_in(intent, "name"));
  if (name.empty())
    name = free_name(level, name_of_type(type_name));
  else
    require_free_name(level, name);
  const std::string path = joined(level.inside, name);
  effects.blocks.push_back(path), effects.what = fmt::format("add {}", path);
  if (const Value::Member* position = intent.find("position")) place(position->value, path, effects);
  draft.change({with_block(level, name, new_block(*type, intent, level))});
}

void add_subdiagram(const Value& intent, const IntentContext& context, Draft& draft, IntentEffects& effects) {
  const Level level = draft.level(context.inside);
  const std::string file = required_text(intent, "file");
  std::string name(text_in(intent, "name"));
  if (name.empty()) {
    const size_t begin = file.find_last_of('/') + 1;  // npos + 1 = 0
    name = file.substr(begin, file.find('.', begin) - begin);
    name = free_name(level, is_name(name) ? name : "subdiagram");
  } else {
    require_free_name(level, name);
  }
  const std::string path = joined(level.inside, name);
  effects.blocks.push_back(path), effects.what = fmt::format("add {}", path);
  if (const Value::Member* position = intent.find("position")) place(position->value, path, effects);
  draft.change({with_block(level, name, fmt::format("{{\"diagram\": {}}}", in_quotes(file)))});
}

/// Whether a source reads one of the blocks.
bool reads(const Value& wire, const std::set<std::string>& blocks) {
  return wire.kind == Kind::text && wire.text.find('.') != std::string::npos &&
         blocks.contains(wire.text.substr(0, wire.text.find('.')));
}

void add(TextChanges& to, TextChanges changes) { std::ranges::move(changes, std::back_inserter(to)); }

/// Leaves out the wires of one input that read the removed blocks, with their signs.
TextChanges without_wires(const Value& body, const Value::Member& port,
                          const std::set<std::string>& removed) {
  std::vector<bool> out;
  for (const Value& wire : port.value.items) out.push_back(reads(wire, removed));
  TextChanges changes = without_entries(port.value, out);
  for (const char* setting : {"signs", "operations"}) {
    const Value::Member* signs = body.find(setting);
    if (!signs || signs->value.text.size() != out.size()) continue;
    std::string rest;
    for (size_t i = 0; i < out.size(); ++i)
      if (!out[i]) rest += signs->value.text[i];
    changes.push_back(replaced(signs->value, in_quotes(rest)));
  }
  return changes;
}

TextChanges without_wires(const Value& block, const Value& body, const std::set<std::string>& removed) {
  const auto in = std::ranges::find(block.members, "in", &Value::Member::name);
  if (in == block.members.end() || in->value.kind != Kind::object || in->value.members.empty()) return {};
  const auto is_all_gone = [&](const Value::Member& port) {
    if (port.value.kind == Kind::list)
      return !port.value.items.empty() &&
             std::ranges::all_of(port.value.items, [&](const Value& w) { return reads(w, removed); });
    return reads(port.value, removed);
  };
  std::vector<bool> gone;
  for (const Value::Member& port : in->value.members) gone.push_back(is_all_gone(port));
  if (std::ranges::all_of(gone, [](bool b) { return b; }))
    return {without_member(block, size_t(in - block.members.begin()))};
  TextChanges changes;
  if (std::ranges::find(gone, true) != gone.end()) changes = without_entries(in->value, gone);
  for (size_t i = 0; i < gone.size(); ++i) {
    const Value::Member& port = in->value.members[i];
    const bool has_some =
        std::ranges::any_of(port.value.items, [&](const Value& w) { return reads(w, removed); });
    if (!gone[i] && has_some) add(changes, without_wires(body, port, removed));
  }
  return changes;
}

void remove_blocks(const Value& intent, const IntentContext& context, Draft& draft, IntentEffects& effects) {
  const Level level = draft.level(context.inside);
  const std::vector<std::string> names = required_texts(intent, "blocks");
  if (names.empty()) throw Refused("no block is named");
  std::set<std::string> removed;
  for (const std::string& name : names) {
    removed.insert(required_block(level, name).name);
    effects.positions.push_back({joined(level.inside, name), std::nullopt});
  }
  effects.what =
      names.size() == 1 ? "remove " + names.front() : fmt::format("remove {} blocks", names.size());
  TextChanges changes;
  std::vector<bool> gone;
  for (const Value::Member& block : level.blocks().members) gone.push_back(removed.contains(block.name));
  add(changes, without_entries(level.blocks(), gone));
  for (const Value::Member& block : level.blocks().members)
    if (!removed.contains(block.name) && block.value.kind == Kind::object)
      add(changes,
          without_wires(block.value, body_of(block.value, joined(level.inside, block.name), draft.variants()),
                        removed));
  if (const Value::Member* log = level.diagram->find("log"); log && log->value.kind == Kind::list) {
    std::vector<bool> out;
    for (const Value& item : log->value.items) out.push_back(reads(item, removed));
    if (std::ranges::find(out, true) != out.end()) {
      const bool is_all =
          std::ranges::find(out, false) == out.end();  // without "log", everything is recorded
      if (is_all && level.diagram->members.size() > 1)
        changes.push_back(without_member(*level.diagram, size_t(log - level.diagram->members.data())));
      else
        add(changes, without_entries(log->value, out));
    }
  }
  draft.change(std::move(changes));
}

void paste(const std::string& text, const Value& intent, const IntentContext& context, Draft& draft,
           IntentEffects& effects) {
  const Level level = draft.level(context.inside);
  const std::vector<CopiedBlock> copies = renamed_copies(text, level);
  if (copies.empty()) throw Refused("the clipboard has no blocks");
  effects.what =
      copies.size() == 1 ? "paste " + copies.front().name : fmt::format("paste {} blocks", copies.size());
  const Value::Member* position = intent.find("position");
  for (const CopiedBlock& copy : copies) {
    const std::string path = joined(level.inside, copy.name);
    draft.change({with_block(draft.level(context.inside), copy.name, copy.text)});
    effects.blocks.push_back(path);
    if (position && position->value.kind == Kind::list && position->value.items.size() == 2) {
      constexpr double apart = 30;  // pixels of the canvas
      const double shift = apart * double(effects.blocks.size() - 1);
      effects.positions.push_back({path, std::pair(position->value.items[0].number + shift,
                                                   position->value.items[1].number + shift)});
    }
  }
}

}  // namespace

bool apply_block_intent(const Value& intent, const IntentContext& context, Draft& draft,
                        IntentEffects& effects) {
  const std::string kind = required_text(intent, "intent");
  if (kind == "add_block") return add_block(intent, context, draft, effects), true;
  if (kind == "add_subdiagram") return add_subdiagram(intent, context, draft, effects), true;
  if (kind == "remove_blocks") return remove_blocks(intent, context, draft, effects), true;
  if (kind == "paste") return paste(required_text(intent, "text"), intent, context, draft, effects), true;
  if (kind == "duplicate") {
    const std::vector<std::string> names = required_texts(intent, "blocks");
    paste(copied_blocks(draft.level(context.inside), names), intent, context, draft, effects);
    effects.what =
        names.size() == 1 ? "duplicate " + names.front() : fmt::format("duplicate {} blocks", names.size());
    return true;
  }
  return false;
}

}  // namespace loopwright::studio
