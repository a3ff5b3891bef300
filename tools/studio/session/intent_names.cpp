/// Intents that give blocks and parameters other names, in every place of the file that uses them.
#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <set>
#include "engine/diagram/expression.h"
#include "engine/json/reader.h"
#include "tools/studio/session/intent.h"
#include "tools/studio/session/member_change.h"
#include "tools/studio/session/renamed_sources.h"

namespace loopwright::studio {
namespace {

using Kind = Value::Kind;

void rename_block(const Value& intent, const IntentContext& context, Draft& draft, IntentEffects& effects) {
  const Level level = draft.level(context.inside);
  const std::string name = required_text(intent, "name"), to = required_text(intent, "to");
  const Value::Member& block = required_block(level, name);
  if (name == to) return;
  require_free_name(level, to);
  effects.what = fmt::format("rename {} to {}", name, to);
  effects.blocks.push_back(joined(level.inside, to));
  effects.renamed.push_back({Renaming::Kind::block, joined(level.inside, name), joined(level.inside, to)});
  TextChanges changes{renamed_member(block, to)};
  std::ranges::move(renamed_sources(*level.diagram, name, to), std::back_inserter(changes));
  std::ranges::move(renamed_in_outer_diagrams(level, name, to), std::back_inserter(changes));
  draft.change(std::move(changes));
}

/// The uses of a parameter in the expressions of a value.
class ParameterUses {
 public:
  ParameterUses(std::string name, std::string to) : name_(std::move(name)), to_(std::move(to)) {}

  void in_value(const Value& value) {
    if (value.kind == Kind::text && value.text.starts_with('='))
      in_expression(value, std::string_view(value.text).substr(1), 1);
    for (const Value& item : value.items) in_value(item);
    for (const Value::Member& member : value.members) in_value(member.value);
  }
  void in_block(const Value& block) {
    for (const Value::Member& member : block.members) {
      if (member.name == "in") continue;
      if (member.name == "variants") {
        for (const Value::Member& variant : member.value.members) in_block(variant.value);
      } else if (member.name == "formula") {
        in_formula(block, member.value);
      } else if (member.name == "states" && text_in(block, "type") == "StateMachine") {
        in_states(block, member.value);
      } else if (member.name != "diagram") {  // a subdiagram has parameters of its own
        in_value(member.value);
      }
    }
  }
  TextChanges take() { return std::move(changes_); }

 private:
  /// The formula of an Expression uses parameters by name; its own names hide them.
  void in_formula(const Value& block, const Value& formula) {
    if (formula.kind != Kind::text) return;
    std::set<std::string> own;
    if (const Value::Member* names = block.find("names"))
      for (const Value& name : names->value.items) own.insert(name.text);
    if (const Value::Member* constants = block.find("constants"))
      for (const Value& constant : constants->value.items) own.insert(std::string(text_in(constant, "name")));
    if (own.contains(name_)) return;
    const size_t skip = formula.text.starts_with('=') ? 1 : 0, before = changes_.size();
    in_expression(formula, std::string_view(formula.text).substr(skip), skip);
    if (changes_.size() > before && own.contains(to_)) refuse_hidden("formula", formula.text);
  }
  /// Values that states set are expressions; guards use parameters by name, which inputs hide.
  void in_states(const Value& machine, const Value& states) {
    in_value(states);
    bool is_hidden = false;
    if (const Value::Member* inputs = machine.find("inputs"))
      for (const Value& input : inputs->value.items) {
        if (input.text == name_) return;
        is_hidden |= input.text == to_;
      }
    for (const Value& state : states.items)
      if (const Value::Member* transitions = state.find("transitions"))
        for (const Value& transition : transitions->value.items)
          if (const Value::Member* guard = transition.find("when")) {
            const size_t before = changes_.size();
            in_guard(guard->value);
            if (changes_.size() > before && is_hidden) refuse_hidden("guard", guard->value.text);
          }
  }
  void in_guard(const Value& guard) {
    const auto is_part = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.';
    };
    std::string changed;
    for (size_t at = 0; at < guard.text.size();) {
      size_t end = at;
      while (end < guard.text.size() && is_part(guard.text[end])) ++end;
      const std::string word = guard.text.substr(at, end - at);
      changed += word == name_ ? to_ : word;
      if (end < guard.text.size()) changed += guard.text[end];
      at = end + 1;
    }
    if (changed != guard.text) changes_.push_back(replaced(guard, in_quotes(changed)));
  }
  void in_expression(const Value& text, std::string_view expression, size_t skip) {
    std::string changed = text.text;
    const std::vector<NameUse> uses = names_in(expression);
    bool is_used = false;
    for (size_t i = uses.size(); i-- > 0;) {
      if (uses[i].is_function || uses[i].name != name_) continue;
      changed.replace(skip + uses[i].offset, name_.size(), to_);
      is_used = true;
    }
    if (is_used) changes_.push_back(replaced(text, in_quotes(changed)));
  }

  /// Where the block has a name of its own, the parameter could not be read under that name.
  [[noreturn]] void refuse_hidden(const char* what, const std::string& text) const {
    throw Refused(fmt::format("the {} \"{}\" has a name \"{}\" of its own, which would hide the parameter",
                              what, text, to_));
  }

  const std::string name_, to_;
  TextChanges changes_;
};

TextChanges uses_in_diagram(const Value& diagram, const std::string& name, const std::string& to) {
  ParameterUses uses(name, to);
  if (const Value::Member* parameters = diagram.find("parameters")) uses.in_value(parameters->value);
  if (const Value::Member* solver = diagram.find("solver")) uses.in_value(solver->value);
  if (const Value::Member* blocks = diagram.find("blocks"))
    for (const Value::Member& block : blocks->value.members) uses.in_block(block.value);
  return uses.take();
}

void rename_parameter(const Value& intent, const IntentContext& context, Draft& draft,
                      IntentEffects& effects) {
  const Level level = draft.level(context.inside);
  const std::string name = required_text(intent, "name"), to = required_text(intent, "to");
  const Value::Member* parameters = level.diagram->find("parameters");
  const Value::Member* parameter = parameters ? parameters->value.find(name) : nullptr;
  if (!parameter) throw Refused(fmt::format("there is no parameter \"{}\"", name));
  if (name == to) return;
  if (!is_name(to) || is_constant_name(to))
    throw Refused(fmt::format("\"{}\" is no name of a parameter", to));
  if (parameters->value.find(to)) throw Refused(fmt::format("there is a parameter \"{}\" already", to));
  effects.what = fmt::format("rename {} to {}", name, to);
  effects.renamed.push_back(
      {Renaming::Kind::parameter, joined(level.inside, name), joined(level.inside, to)});
  TextChanges changes = uses_in_diagram(*level.diagram, name, to);
  changes.push_back(renamed_member(*parameter, to));
  // The block that contains this diagram passes a value on by name.
  if (!level.outer.empty()) {
    const std::vector<std::string> steps = split_path(level.inside);
    const Value::Member* block = level.outer.back()->find("blocks")->value.find(steps.back());
    const Value& body = body_of(block->value, level.inside, draft.variants());
    if (const Value::Member* passed = body.find("parameters"))
      if (const Value::Member* own = passed->value.find(name)) changes.push_back(renamed_member(*own, to));
  }
  draft.change(std::move(changes));
}

}  // namespace

TextChanges uses_of_parameter(const Value& value, const std::string& name, const std::string& to) {
  ParameterUses uses(name, to);
  uses.in_value(value);
  return uses.take();
}

TextChanges renamed_sources(const Value& diagram, const std::string& path, const std::string& new_path) {
  TextChanges changes;
  each_source(diagram, [&](const Value& source) {
    if (source.text.starts_with(path + "."))
      changes.push_back(replaced(source, in_quotes(new_path + source.text.substr(path.size()))));
  });
  return changes;
}

TextChanges renamed_in_outer_diagrams(const Level& level, const std::string& name, const std::string& to) {
  TextChanges changes;
  const std::vector<std::string> steps =
      level.inside.empty() ? std::vector<std::string>() : split_path(level.inside);
  std::string prefix;
  for (size_t i = level.outer.size(); i-- > 0;) {
    prefix = joined(steps[i], prefix);
    if (prefix.ends_with('.')) prefix.pop_back();
    std::ranges::move(renamed_sources(*level.outer[i], joined(prefix, name), joined(prefix, to)),
                      std::back_inserter(changes));
  }
  return changes;
}

bool apply_name_intent(const Value& intent, const IntentContext& context, Draft& draft,
                       IntentEffects& effects) {
  const std::string kind = required_text(intent, "intent");
  if (kind == "rename_block") return rename_block(intent, context, draft, effects), true;
  if (kind == "rename_parameter") return rename_parameter(intent, context, draft, effects), true;
  return false;
}

}  // namespace loopwright::studio
