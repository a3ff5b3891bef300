/// Intents about the parameters of a diagram, and changes typed in the text.
#include <fmt/format.h>
#include <algorithm>
#include "engine/diagram/expression.h"
#include "engine/json/reader.h"
#include "tools/studio/session/intent.h"
#include "tools/studio/session/member_change.h"
#include "tools/studio/session/setting_text.h"

namespace loopwright::studio {
namespace {

using Kind = Value::Kind;

const Value::Member& required_parameter(const Level& level, const std::string& name) {
  const Value::Member* parameters = level.diagram->find("parameters");
  const Value::Member* parameter = parameters ? parameters->value.find(name) : nullptr;
  if (!parameter) throw Refused(fmt::format("there is no parameter \"{}\"", name));
  return *parameter;
}

void add(const Level& level, const Value& intent, const std::string& name, Draft& draft) {
  if (!is_name(name) || is_constant_name(name))
    throw Refused(fmt::format("\"{}\" is no name of a parameter", name));
  const Value::Member* parameters = level.diagram->find("parameters");
  if (parameters && parameters->value.find(name))
    throw Refused(fmt::format("there is a parameter \"{}\" already", name));
  std::string json = json_of_typed(required_text(intent, "text"), nullptr);
  const std::string description(text_in(intent, "description"));
  if (!description.empty()) {
    const bool has_unit = json.starts_with("{\"value\": ");
    if (has_unit) json.pop_back();
    json = fmt::format("{}, \"description\": {}}}", has_unit ? json : "{\"value\": " + json,
                       in_quotes(description));
  }
  if (parameters)
    draft.change({with_member(parameters->value, name, json, "    ")});
  else
    draft.change(
        {with_top_member(*level.diagram, "parameters", fmt::format("{{{}: {}}}", in_quotes(name), json))});
}

void describe(const Level& level, const std::string& name, const std::string& text, Draft& draft) {
  const Value& value = required_parameter(level, name).value;
  if (value.kind != Kind::object || !value.find("value")) {
    if (!text.empty())
      draft.change({replaced(
          value, fmt::format("{{\"value\": {}, \"description\": {}}}", source_of(value), in_quotes(text)))});
    return;
  }
  const auto member = std::ranges::find(value.members, "description", &Value::Member::name);
  if (member == value.members.end()) {
    if (!text.empty()) draft.change({with_member(value, "description", in_quotes(text))});
  } else if (text.empty()) {
    draft.change({without_member(value, size_t(member - value.members.begin()))});
  } else {
    draft.change({replaced(member->value, in_quotes(text))});
  }
}

/// A change typed in the text view; its places are counted in UTF-16 units.
TextChange typed_change(const Value& change, const Utf16& places, size_t size) {
  const auto from = optional_whole(change, "from", -1), to = optional_whole(change, "to", -1);
  const size_t units = places.units(size);
  if (from < 0 || to < from || size_t(to) > units) throw Refused("a change lies outside of the text");
  return {places.bytes(size_t(from)), places.bytes(size_t(to)), required_text(change, "text")};
}

}  // namespace

bool apply_parameter_intent(const Value& intent, const IntentContext& context, Draft& draft,
                            IntentEffects& effects) {
  const std::string kind = required_text(intent, "intent");
  if (kind != "set_parameter" && kind != "add_parameter" && kind != "remove_parameter" &&
      kind != "describe_parameter")
    return false;
  const Level level = draft.level(context.inside);
  const std::string name = required_text(intent, "name");
  if (kind == "set_parameter") {
    effects.what = "set " + name;
    draft.change(retyped(required_parameter(level, name).value, required_text(intent, "text"), nullptr));
  } else if (kind == "add_parameter") {
    effects.what = "add the parameter " + name;
    add(level, intent, name, draft);
  } else if (kind == "describe_parameter") {
    effects.what = "describe " + name;
    describe(level, name, required_text(intent, "text"), draft);
  } else {
    effects.what = "remove the parameter " + name;
    const Value::Member& parameter = required_parameter(level, name);
    const Value& parameters = level.diagram->find("parameters")->value;
    draft.change({without_member(parameters, size_t(&parameter - parameters.members.data()))});
  }
  return true;
}

bool apply_text_intent(const Value& intent, Draft& draft, IntentEffects& effects) {
  const std::string kind = required_text(intent, "intent");
  if (kind == "replace_text") {
    effects.what = "change the text";
    draft.change(difference(draft.text(), required_text(intent, "text")));
    return true;
  }
  if (kind != "text") return false;
  effects.what = "type";
  const Utf16 places(draft.text());
  TextChanges changes;
  if (const Value::Member* edits = intent.find("edits")) {
    for (const Value& edit : edits->value.items)
      changes.push_back(typed_change(edit, places, draft.text().size()));
  } else {
    changes.push_back(typed_change(intent, places, draft.text().size()));
  }
  std::ranges::sort(changes, {}, &TextChange::from);
  for (size_t i = 1; i < changes.size(); ++i)
    if (changes[i].from < changes[i - 1].to) throw Refused("changes of the text overlap");
  draft.change(std::move(changes));
  return true;
}

}  // namespace loopwright::studio
