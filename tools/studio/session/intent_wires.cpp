/// Intents about wires, and about the signals that are recorded.
#include <fmt/format.h>
#include <algorithm>
#include "engine/block/registry.h"
#include "engine/diagram/wires.h"
#include "engine/json/reader.h"
#include "tools/studio/session/intent.h"
#include "tools/studio/session/member_change.h"
#include "tools/studio/session/written_wires.h"

namespace loopwright::studio {
namespace {

using Kind = Value::Kind;

/// Blocks with a setting that has one character for each wire of an input.
struct SignPerWire {
  std::string_view type, port, setting;
  char added;
};
constexpr SignPerWire signs_per_wire[] = {{"Sum", "terms", "signs", '+'},
                                          {"Product", "factors", "operations", '*'}};

const Value::Member* signs_of(const Value& body, const std::string& port, char& added) {
  for (const SignPerWire& sign : signs_per_wire)
    if (sign.type == text_in(body, "type") && sign.port == port) {
      const Value::Member* setting = body.find(sign.setting);
      added = sign.added;
      return setting && setting->value.kind == Kind::text ? setting : nullptr;
    }
  return nullptr;
}

bool takes_many(const Value& body, const std::string& port) {
  const BlockType* type = find_block(text_in(body, "type"));
  if (!type) return false;
  for (const PortInfo& input : type->info.inputs)
    if (input.name == port) return input.shape == PortInfo::Shape::many;
  return false;
}

/// An input of a block, as a request names it: "feedback.terms".
struct Target {
  const Value::Member* block = nullptr;
  const Value* body = nullptr;
  std::string port, path;
};

Target target_of(const Level& level, const std::string& to, const Draft& draft) {
  const size_t dot = to.find('.');
  Target target;
  target.port = dot == to.npos ? "" : to.substr(dot + 1);
  if (!is_name(target.port)) throw Refused(fmt::format("\"{}\" is no input of a block", to));
  target.block = &required_block(level, to.substr(0, dot));
  target.path = joined(level.inside, target.block->name);
  target.body = &body_of(target.block->value, target.path, draft.variants());
  return target;
}

void connect_output(const Level& level, const std::string& from, const std::string& to, Draft& draft) {
  const Value::Member* outputs = level.diagram->find("outputs");
  const Value::Member* output = outputs ? outputs->value.find(to) : nullptr;
  if (!output) throw Refused(fmt::format("the diagram has no output \"{}\"", to));
  const Value::Member* source = output->value.kind == Kind::object ? output->value.find("source") : nullptr;
  if (source)
    draft.change({replaced(source->value, in_quotes(from))});
  else if (output->value.kind == Kind::object)
    draft.change({with_member(output->value, "source", in_quotes(from))});
  else
    draft.change({replaced(output->value, in_quotes(from))});
}

TextChanges added_to(const Target& target, const Value& wires, const std::string& from) {
  TextChanges changes;
  if (wires.kind == Kind::list)
    changes.push_back(with_item(wires, in_quotes(from)));
  else
    changes.push_back(replaced(wires, fmt::format("[{}, {}]", source_of(wires), in_quotes(from))));
  char added = '+';
  if (const Value::Member* signs = signs_of(*target.body, target.port, added)) {
    const size_t wires_now = wires.kind == Kind::list ? wires.items.size() : 1;
    if (signs->value.text.size() == wires_now)  // otherwise the author is in the middle of a change
      changes.push_back(replaced(signs->value, in_quotes(signs->value.text + added)));
  }
  return changes;
}

void connect(const Value& intent, const IntentContext& context, Draft& draft, IntentEffects& effects) {
  const Level level = draft.level(context.inside);
  const std::string from = required_text(intent, "from"), to = required_text(intent, "to");
  if (!is_port(from)) throw Refused(fmt::format("\"{}\" does not name a port", from));
  effects.what = fmt::format("connect {} to {}", from, to);
  if (to.find('.') == to.npos) return connect_output(level, from, to, draft);
  const Target target = target_of(level, to, draft);
  effects.blocks.push_back(target.path);
  if (is_condition(target.port)) {
    const Value* condition = wires_into(target.block->value, target.port);
    draft.change({condition ? replaced(*condition, in_quotes(from))
                            : with_member(target.block->value, target.port, in_quotes(from))});
    return;
  }
  const Value::Member* in = target.block->value.find("in");
  if (!in) {
    draft.change({with_member(target.block->value, "in",
                              fmt::format("{{{}: {}}}", in_quotes(target.port), in_quotes(from)))});
    return;
  }
  if (in->value.kind != Kind::object) throw Refused("\"in\" is no object");
  const Value::Member* port = in->value.find(target.port);
  if (!port) {
    const bool is_list = takes_many(*target.body, target.port);
    draft.change({with_member(in->value, target.port,
                              is_list ? fmt::format("[{}]", in_quotes(from)) : in_quotes(from))});
    return;
  }
  const Value& wires = port->value;
  const int64_t index = optional_whole(intent, "index", -1);
  if (wires.kind == Kind::list && index >= 0 && index < int64_t(wires.items.size()))
    draft.change({replaced(wires.items[size_t(index)], in_quotes(from))});
  else if (takes_many(*target.body, target.port) && (wires.kind == Kind::list || index != 0))
    draft.change(added_to(target, wires, from));
  else
    draft.change({replaced(wires, in_quotes(from))});
}

void disconnect(const Value& intent, const IntentContext& context, Draft& draft, IntentEffects& effects) {
  const Level level = draft.level(context.inside);
  const std::string to = required_text(intent, "to");
  const Target target = target_of(level, to, draft);
  effects.what = fmt::format("disconnect {}", to);
  effects.blocks.push_back(target.path);
  const Value& block = target.block->value;
  if (is_condition(target.port) && wires_into(block, target.port)) {
    draft.change({without_member(block, size_t(block.find(target.port) - block.members.data()))});
    return;
  }
  const Value::Member* in = target.block->value.find("in");
  const Value::Member* port = in ? in->value.find(target.port) : nullptr;
  if (!port) throw Refused(fmt::format("\"{}\" has no wire", to));
  const auto index = size_t(optional_whole(intent, "index", 0));
  if (port->value.kind == Kind::list && port->value.items.size() > 1) {
    if (index >= port->value.items.size()) throw Refused(fmt::format("\"{}\" has no wire {}", to, index));
    TextChanges changes{without_item(port->value, index)};
    char added = '+';
    if (const Value::Member* signs = signs_of(*target.body, target.port, added);
        signs && signs->value.text.size() == port->value.items.size()) {
      std::string rest = signs->value.text;
      changes.push_back(replaced(signs->value, in_quotes(rest.erase(index, 1))));
    }
    draft.change(std::move(changes));
    return;
  }
  const bool is_only_port = in->value.members.size() == 1;
  const Value& owner = is_only_port ? target.block->value : in->value;
  const Value::Member* gone = is_only_port ? in : port;
  draft.change({without_member(owner, size_t(gone - owner.members.data()))});
}

void log(const Value& intent, const IntentContext& context, Draft& draft, IntentEffects& effects) {
  const Level level = draft.level("");
  const std::string port = required_text(intent, "port");
  const Value::Member* on = intent.find("on");
  const bool is_wanted = !on || on->value.kind != Kind::boolean || on->value.boolean;
  if (!is_port(port)) throw Refused(fmt::format("\"{}\" does not name a port", port));
  effects.what = fmt::format("{} {}", is_wanted ? "record" : "do not record", port);
  const Value::Member* log = level.diagram->find("log");
  if (log && log->value.kind == Kind::list) {
    const auto found = std::ranges::find(log->value.items, port, &Value::text);
    const bool is_there = found != log->value.items.end();
    if (is_wanted && !is_there) draft.change({with_item(log->value, in_quotes(port))});
    if (!is_wanted && is_there)
      draft.change({without_item(log->value, size_t(found - log->value.items.begin()))});
    return;
  }
  std::vector<std::string> names = context.recorded ? context.recorded() : std::vector<std::string>();
  const bool is_there = std::ranges::find(names, port) != names.end();
  if (is_wanted == is_there) return;
  if (is_wanted)
    names.push_back(port);
  else
    std::erase(names, port);
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + in_quotes(name);
  draft.change({with_top_member(*level.diagram, "log", "[" + list + "]")});
}

}  // namespace

bool apply_wire_intent(const Value& intent, const IntentContext& context, Draft& draft,
                       IntentEffects& effects) {
  const std::string kind = required_text(intent, "intent");
  if (kind == "connect") return connect(intent, context, draft, effects), true;
  if (kind == "disconnect") return disconnect(intent, context, draft, effects), true;
  if (kind == "log") return log(intent, context, draft, effects), true;
  return false;
}

}  // namespace loopwright::studio
