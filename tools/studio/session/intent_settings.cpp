/// Intents that change values: settings of blocks, variants, the solver, title and description.
#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include "engine/block/registry.h"
#include "engine/json/reader.h"
#include "tools/studio/session/intent.h"
#include "tools/studio/session/member_change.h"
#include "tools/studio/session/setting_text.h"

namespace loopwright::studio {
namespace {

using Kind = Value::Kind;

/// Where a setting stands, or would stand.
struct SettingPlace {
  const Value* container = nullptr;
  const Value* value = nullptr;  // null: not there yet
  size_t index = 0;              // in the container
  std::string name;              // of a member that is not there yet
};

SettingPlace find_setting(const Value& object, std::span<const std::string> path) {
  const Value* at = &object;
  for (size_t i = 0; i < path.size(); ++i) {
    const bool is_last = i + 1 == path.size();
    if (at->kind == Kind::object) {
      const auto member = std::ranges::find(at->members, path[i], &Value::Member::name);
      if (member == at->members.end()) {
        if (!is_last) throw Refused(fmt::format("there is no \"{}\"", path[i]));
        return {at, nullptr, 0, path[i]};
      }
      if (is_last) return {at, &member->value, size_t(member - at->members.begin()), path[i]};
      at = &member->value;
    } else if (at->kind == Kind::list) {
      size_t index = 0;
      const char* const end = path[i].data() + path[i].size();
      const auto [stop, code] = std::from_chars(path[i].data(), end, index);
      const bool is_next = is_last && index == at->items.size();
      if (code != std::errc() || stop != end || (index >= at->items.size() && !is_next))
        throw Refused(fmt::format("the list has no item {}", path[i]));
      if (is_last) return {at, is_next ? nullptr : &at->items[index], index, path[i]};
      at = &at->items[index];
    } else {
      throw Refused(fmt::format("\"{}\" has no \"{}\"", path[i ? i - 1 : 0], path[i]));
    }
  }
  throw Refused("the setting has no name");
}

TextChanges written(const SettingPlace& place, const std::string& typed, const ParameterInfo* info) {
  if (typed.find_first_not_of(" \t\r\n") == typed.npos) {
    if (!place.value) return {};
    std::vector<bool> leave_out(std::max(place.container->members.size(), place.container->items.size()));
    leave_out[place.index] = true;
    return without_entries(*place.container, leave_out);
  }
  if (place.value) return retyped(*place.value, typed, info);
  if (place.container->kind == Kind::list)
    return {with_item(*place.container, json_of_typed(typed, info))};
  if (!is_name(place.name) && place.name != "$schema")
    throw Refused(fmt::format("\"{}\" is no name", place.name));
  const std::string json = json_of_typed(typed, info);
  const auto in = std::ranges::find(place.container->members, "in", &Value::Member::name);
  if (in != place.container->members.end())  // settings come before the wires
    return {with_member_before(*place.container, size_t(in - place.container->members.begin()), place.name,
                               json)};
  return {with_member(*place.container, place.name, json)};
}

constexpr ParameterInfo text_parameter() {
  ParameterInfo info;
  info.kind = ParameterKind::text;
  return info;
}

void set(const Value& intent, const IntentContext& context, Draft& draft, IntentEffects& effects) {
  const Level level = draft.level(context.inside);
  const std::string name = required_text(intent, "block"), setting = required_text(intent, "setting");
  const std::string typed = required_text(intent, "text");
  const Value::Member& block = required_block(level, name);
  const std::string path = joined(level.inside, name);
  const Value& body = body_of(block.value, path, draft.variants());
  const std::vector<std::string> steps = split_path(setting);
  static const std::vector<std::string_view> not_settings = {"in", "variants", "variant"};
  if (std::ranges::find(not_settings, steps.front()) != not_settings.end())
    throw Refused(fmt::format("\"{}\" is not a setting", steps.front()));
  effects.blocks.push_back(path), effects.what = fmt::format("set {}.{}", path, setting);
  const ParameterInfo text = text_parameter();
  const bool is_of_engine = setting == "type" || setting == "diagram" || setting == "description";
  if (is_of_engine && !(setting == "diagram" && !subdiagram_of(body))) {
    const Value& owner = setting == "description" ? block.value : body;
    draft.change(written(find_setting(owner, steps), typed, &text));
    return;
  }
  if (subdiagram_of(body) && setting != "sample_time" && setting != "sample_offset") {
    const Value::Member* parameters = body.find("parameters");
    if (parameters) {
      draft.change(written(find_setting(parameters->value, steps), typed, nullptr));
    } else if (!typed.empty()) {
      if (!is_name(setting)) throw Refused(fmt::format("there is no parameter \"{}\"", setting));
      const std::string json = fmt::format("{{{}: {}}}", in_quotes(setting), json_of_typed(typed, nullptr));
      draft.change({with_member(body, "parameters", json)});
    }
    return;
  }
  const BlockType* type = find_block(text_in(body, "type"));
  const ParameterInfo* info = type ? find_parameter(type->info.parameters, steps) : nullptr;
  draft.change(written(find_setting(body, steps), typed, info));
}

void choose_variant(const Value& intent, const IntentContext& context, Draft& draft, IntentEffects& effects) {
  const Level level = draft.level(context.inside);
  const std::string name = required_text(intent, "block"), variant = required_text(intent, "variant");
  const Value& block = required_block(level, name).value;
  const auto variants = std::ranges::find(block.members, "variants", &Value::Member::name);
  if (variants == block.members.end() || !variants->value.find(variant))
    throw Refused(fmt::format("the block has no variant \"{}\"", variant));
  effects.blocks.push_back(joined(level.inside, name));
  effects.what = fmt::format("variant {} of {}", variant, name);
  if (const Value::Member* chosen = block.find("variant"))
    draft.change({replaced(chosen->value, in_quotes(variant))});
  else if (variants + 1 != block.members.end())
    draft.change({with_member_before(block, size_t(variants + 1 - block.members.begin()), "variant",
                                     in_quotes(variant))});
  else
    draft.change({with_member(block, "variant", in_quotes(variant))});
}

void set_solver(const Value& intent, const IntentContext& context, Draft& draft, IntentEffects& effects) {
  const Level level = draft.level(context.inside);
  const std::string name = required_text(intent, "name"), typed = required_text(intent, "text");
  effects.what = "set the solver's " + name;
  if (!is_name(name)) throw Refused(fmt::format("\"{}\" is no name", name));
  const std::vector<std::string> path{name};
  const bool is_text = name == "method" || name == "algebraic_loops";
  const ParameterInfo text = text_parameter();
  if (const Value::Member* solver = level.diagram->find("solver"))
    draft.change(written(find_setting(solver->value, path), typed, is_text ? &text : nullptr));
  else if (!typed.empty())
    draft.change({with_top_member(
        *level.diagram, "solver",
        fmt::format("{{{}: {}}}", in_quotes(name), json_of_typed(typed, is_text ? &text : nullptr)))});
}

void set_top_text(const std::string& name, const Value& intent, const IntentContext& context, Draft& draft) {
  const Level level = draft.level(context.inside);
  const std::string text = required_text(intent, "text");
  const auto member = std::ranges::find(level.diagram->members, name, &Value::Member::name);
  if (member == level.diagram->members.end()) {
    if (!text.empty()) draft.change({with_top_member(*level.diagram, name, in_quotes(text))});
  } else if (text.empty()) {
    draft.change({without_member(*level.diagram, size_t(member - level.diagram->members.begin()))});
  } else {
    draft.change({replaced(member->value, in_quotes(text))});
  }
}

}  // namespace

bool apply_setting_intent(const Value& intent, const IntentContext& context, Draft& draft,
                          IntentEffects& effects) {
  const std::string kind = required_text(intent, "intent");
  if (kind == "set") return set(intent, context, draft, effects), true;
  if (kind == "choose_variant") return choose_variant(intent, context, draft, effects), true;
  if (kind == "set_solver") return set_solver(intent, context, draft, effects), true;
  if (kind != "set_title" && kind != "set_description") return false;
  effects.what = kind == "set_title" ? "change the title" : "change the description";
  set_top_text(kind == "set_title" ? "title" : "description", intent, context, draft);
  return true;
}

}  // namespace loopwright::studio
