#include "tools/studio/session/intent.h"
#include <fmt/format.h>
#include <algorithm>
#include "engine/json/json.h"
#include "engine/json/reader.h"
#include "models/real/whole.h"
#include "tools/studio/session/member_change.h"

namespace loopwright::studio {

using Kind = Value::Kind;

std::string required_text(const Value& intent, std::string_view name) {
  const Value::Member* member = intent.find(name);
  if (!member || member->value.kind != Kind::text)
    throw Refused(fmt::format("the request lacks the text \"{}\"", name));
  return member->value.text;
}

int64_t optional_whole(const Value& intent, std::string_view name, int64_t otherwise) {
  const Value::Member* member = intent.find(name);
  if (!member || member->value.kind == Kind::null) return otherwise;
  constexpr double largest = 9e15;
  if (member->value.kind != Kind::number || !member->value.whole || std::abs(member->value.number) > largest)
    throw Refused(fmt::format("\"{}\" is no whole number", name));
  return whole_between<int64_t>(member->value.number, int64_t(-largest), int64_t(largest));
}

std::vector<std::string> required_texts(const Value& intent, std::string_view name) {
  const Value::Member* member = intent.find(name);
  if (!member || member->value.kind != Kind::list)
    throw Refused(fmt::format("the request lacks the list \"{}\"", name));
  std::vector<std::string> texts;
  for (const Value& item : member->value.items) {
    if (item.kind != Kind::text) throw Refused(fmt::format("\"{}\" is no list of texts", name));
    texts.push_back(item.text);
  }
  return texts;
}

const Value::Member& required_block(const Level& level, const std::string& name) {
  const Value::Member* block = level.block(name);
  if (!block || block->value.kind != Kind::object)
    throw Refused(fmt::format("there is no block \"{}\"", joined(level.inside, name)));
  return *block;
}

void require_free_name(const Level& level, const std::string& name) {
  if (!is_name(name))
    throw Refused(
        fmt::format("\"{}\" is no name: letters, digits and underscores, not starting with a digit", name));
  if (level.block(name)) throw Refused(fmt::format("there is a block \"{}\" already", name));
  if (const auto* inputs = level.diagram->find("inputs"); inputs && inputs->value.find(name))
    throw Refused(fmt::format("an input of the diagram has the name \"{}\"", name));
}

std::string free_name(const Level& level, const std::string& wanted) {
  const Value::Member* inputs = level.diagram->find("inputs");
  const auto is_used = [&](const std::string& name) {
    return level.block(name) || (inputs && inputs->value.find(name));
  };
  // "gain_2" is followed by "gain_3", not by "gain_2_2".
  std::string base = wanted;
  const size_t last = base.find_last_not_of("0123456789");
  if (last != base.npos && base[last] == '_' && last > 0 && last + 1 < base.size()) base.resize(last);
  std::string name = wanted;
  for (int i = 2; is_used(name); ++i) name = fmt::format("{}_{}", base, i);
  return name;
}

TextChange with_top_member(const Value& diagram, const std::string& name, const std::string& value) {
  static const std::vector<std::string_view> order = {"$schema",    "loopwright", "title",  "description",
                                                      "parameters", "solver",     "inputs", "blocks",
                                                      "outputs",    "log"};
  const auto rank = [](std::string_view key) { return std::ranges::find(order, key) - order.begin(); };
  for (size_t i = 0; i < diagram.members.size(); ++i)
    if (rank(diagram.members[i].name) > rank(name)) return with_member_before(diagram, i, name, value);
  return with_member(diagram, name, value);
}

TextChanges without_entries(const Value& value, const std::vector<bool>& leave_out) {
  std::vector<std::pair<size_t, size_t>> spans;
  for (const Value::Member& member : value.members)
    spans.emplace_back(member.place.offset, end_of(member.value));
  for (const Value& item : value.items) spans.emplace_back(item.place.offset, end_of(item));
  const size_t count = spans.size();
  if (std::ranges::all_of(leave_out, [](bool out) { return out; }))
    return {{size_t(value.place.offset) + 1, end_of(value) - 1, ""}};
  TextChanges changes;
  for (size_t i = 0; i < count; ++i) {
    if (!leave_out[i]) continue;
    size_t last = i;
    while (last + 1 < count && leave_out[last + 1]) ++last;
    if (last + 1 < count)
      changes.push_back({spans[i].first, spans[last + 1].first, ""});
    else
      changes.push_back({spans[i - 1].second, spans[last].second, ""});
    i = last;
  }
  return changes;
}

void apply_intent(const Value& intent, const IntentContext& context, Draft& draft, IntentEffects& effects) {
  if (intent.kind != Kind::object) throw Refused("an intent is an object");
  if (apply_text_intent(intent, draft, effects)) return;
  if (!draft.parsed().is_object())
    throw Refused("the text of the file is not JSON: it can only be changed as text");
  if (apply_setting_intent(intent, context, draft, effects) ||
      apply_parameter_intent(intent, context, draft, effects) ||
      apply_wire_intent(intent, context, draft, effects) ||
      apply_block_intent(intent, context, draft, effects) ||
      apply_name_intent(intent, context, draft, effects) ||
      apply_wrap_intent(intent, context, draft, effects))
    return;
  throw Refused(fmt::format("there is no intent \"{}\"", required_text(intent, "intent")));
}

}  // namespace loopwright::studio
