/// Palette, help on types, completion and explanations in the text.
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <set>
#include "engine/block/registry.h"
#include "engine/json/reader.h"
#include "tools/reference/reference.h"
#include "tools/studio/session/member_change.h"
#include "tools/studio/session/session.h"
#include "tools/studio/session/setting_text.h"

namespace loopwright::studio {
namespace {

using Kind = Value::Kind;

std::string_view name_of(ParameterKind kind) {
  static constexpr std::string_view names[] = {"number", "whole",  "flag", "text",
                                               "file",   "choice", "list", "object"};
  return names[size_t(kind)];
}

Json parameter_json(const ParameterInfo& info) {
  Json json{{"name", info.name},
            {"unit", info.unit},
            {"sentence", info.sentence},
            {"kind", name_of(info.kind)},
            {"low", finite(info.low)},
            {"high", finite(info.high)},
            {"required", !info.has_default},
            {"default", info.default_text},
            {"choices", Json::array()}};
  for (std::string_view choice : info.choices) json["choices"].push_back(choice);
  if (!info.fields.empty()) {
    json["fields"] = Json::array();
    for (const ParameterInfo& field : info.fields) json["fields"].push_back(parameter_json(field));
  }
  return json;
}

Json port_json(const PortInfo& port) {
  return {{"name", port.name},
          {"unit", port.unit},
          {"sentence", port.sentence},
          {"many", port.shape == PortInfo::Shape::many},
          {"optional", port.is_optional}};
}

/// Whether a port of a type may have the unit; a port whose unit is open takes any.
bool may_have(std::string_view declared, const std::optional<Unit>& wanted) {
  if (!wanted || declared.find('$') != declared.npos || declared == "?") return true;
  const auto unit = parse_unit(declared);
  return unit && unit->fits(*wanted);
}

bool has_port(const std::vector<PortInfo>& ports, const std::optional<Unit>& unit) {
  return std::ranges::any_of(ports, [&](const PortInfo& port) { return may_have(port.unit, unit); });
}

/// The innermost value or name of a member at a place.
struct At {
  const Value* value = nullptr;
  std::vector<const Value::Member*> members;  ///< that lead to it, outermost first
  bool is_name = false;                       ///< the place is in the name of the last member
};

At find_at(const Value& root, size_t offset) {
  At at{&root, {}, false};
  while (true) {
    const Value* next = nullptr;
    for (const Value::Member& member : at.value->members) {
      if (offset < member.place.offset || offset > end_of(member.value)) continue;
      at.members.push_back(&member);
      if (offset < member.value.place.offset) {
        at.is_name = true;
        return at;
      }
      next = &member.value;
      break;
    }
    for (const Value& item : at.value->items)
      if (!next && offset >= item.place.offset && offset <= end_of(item)) next = &item;
    if (!next) return at;
    at.value = next;
  }
}

/// The block in which a place lies: the member after "blocks".
const Value::Member* block_at(const At& at, size_t* depth) {
  for (size_t i = at.members.size(); i-- > 1;)
    if (at.members[i - 1]->name == "blocks") {
      *depth = i;
      return at.members[i];
    }
  return nullptr;
}

std::string explained(const At& at, const BlockType* type, size_t depth, const Value::Member& block) {
  if (at.members.size() == depth + 1)
    return type ? fmt::format("{}: {}\n{}", block.name, type->info.type, type->info.sentence) : block.name;
  const Value::Member& setting = *at.members[depth + 1];
  if (!type) return "";
  if (setting.name == "type") return block_text(type->info);
  if (setting.name == "in" && at.members.size() > depth + 2)
    for (const PortInfo& port : type->info.inputs)
      if (port.name == at.members[depth + 2]->name)
        return fmt::format("{} [{}]: {}", port.name, port.unit, port.sentence);
  const std::vector<std::string> path{setting.name};
  const ParameterInfo* info = find_parameter(type->info.parameters, path);
  if (!info) return "";
  return fmt::format("{}{}: {}", info->name, info->unit.empty() ? "" : fmt::format(" [{}]", info->unit),
                     info->sentence);
}

void option(Json& list, const std::string& label, std::string_view detail) {
  list.push_back({{"label", label}, {"detail", detail}, {"apply", in_quotes(label)}});
}

/// Every output that a block of the level may read.
void add_sources(const Value& root, Json& options) {
  const Value::Member* blocks = root.find("blocks");
  if (!blocks) return;
  for (const Value::Member& block : blocks->value.members)
    if (const BlockType* type = find_block(text_in(block.value, "type")))
      for (const PortInfo& port : type->info.outputs)
        option(options, fmt::format("{}.{}", block.name, port.name), port.sentence);
  if (const Value::Member* inputs = root.find("inputs"))
    for (const Value::Member& input : inputs->value.members)
      option(options, input.name, "input of the diagram");
}

void add_settings(const Value& block, const BlockType& type, Json& options) {
  for (const ParameterInfo& info : type.info.parameters)
    if (!block.find(info.name)) option(options, std::string(info.name), info.sentence);
  for (const char* key : {"in", "sample_time", "description"})
    if (!block.find(key)) option(options, key, "");
}

}  // namespace

Json Session::find_blocks(const Request& request) {
  const std::string words = request.text("text"), fits = request.text("fits");
  std::optional<Unit> unit = request.text("unit").empty() ? std::nullopt : parse_unit(request.text("unit"));
  bool is_input = false;
  if (!fits.empty() && !request.text("path").empty()) {
    const std::string path = request.text("path");
    const CheckedText text = check_text(folder_.path_of(path), document(path).text(), {});
    const Plan* plan = text.checked.plan.get();
    const std::string port = joined(request.text("inside"), fits);
    const std::vector<Number> numbers = plan ? plan->find(port) : std::vector<Number>();
    if (!numbers.empty()) unit = plan->unit_of(numbers.front());
    is_input = request.text("side") == "input";
  }
  Json list = Json::array();
  const auto add = [&](const std::string& name, const std::string& why) {
    const BlockType* type = loopwright::find_block(name);
    if (!type) return;
    const bool suits = fits.empty() && !unit ? true
                       : fits.empty()
                           ? has_port(type->info.inputs, unit) || has_port(type->info.outputs, unit)
                           : has_port(is_input ? type->info.outputs : type->info.inputs, unit);
    if (suits)
      list.push_back(
          {{"type", name}, {"room", type->info.room}, {"sentence", type->info.sentence}, {"why", why}});
  };
  if (words.empty())
    for (const auto& [name, type] : all_blocks()) add(name, "");
  else
    for (const FoundBlock& found : loopwright::find_blocks(words))
      add(found.type, found.where == FoundBlock::Where::elsewhere ? found.name + ": " + found.text : "");
  return {{"types", std::move(list)}};
}

Json Session::type(const Request& request) {
  const std::string name = request.required("type");
  const BlockType* type = loopwright::find_block(name);
  if (!type) throw Refused(fmt::format("there is no block type \"{}\"; {}", name, block_type_hint(name)));
  const BlockInfo& info = type->info;
  Json json{{"type", name},
            {"room", info.room},
            {"sentence", info.sentence},
            {"inputs", Json::array()},
            {"outputs", Json::array()},
            {"settings", Json::array()}};
  for (const PortInfo& port : info.inputs) json["inputs"].push_back(port_json(port));
  for (const PortInfo& port : info.outputs) json["outputs"].push_back(port_json(port));
  for (const ParameterInfo& parameter : info.parameters)
    json["settings"].push_back(parameter_json(parameter));
  json["sampled"] = info.is_sampled, json["continuous"] = info.is_continuous;
  json["help"] = block_text(info);
  return json;
}

Json Session::hover(const Request& request) {
  const std::string path = request.required("path");
  const ParsedText parsed(path, document(path).text());
  if (!parsed.is_object()) return {{"text", ""}};
  const Utf16 places(parsed.file->text);
  const At at = find_at(parsed.root, places.bytes(size_t(std::max<int64_t>(0, request.whole("offset", 0)))));
  size_t depth = 0;
  const Value::Member* block = block_at(at, &depth);
  if (!block || at.members.empty()) return {{"text", ""}};
  const Value& body = body_of(block->value, block->name, {});
  const Value::Member& innermost = *at.members.back();
  return {{"from", places.units(innermost.place.offset)},
          {"to", places.units(end_of(innermost.value))},
          {"text", explained(at, loopwright::find_block(text_in(body, "type")), depth, *block)},
          {"block", block->name}};
}

/// The text under the cursor is usually not JSON yet: what is typed is closed by quotes first.
Json Session::complete(const Request& request) {
  const std::string path = request.required("path");
  const ParsedText parsed(path, document(path).text());
  Json options = Json::array();
  if (!parsed.is_object()) return {{"options", options}};
  const Utf16 places(parsed.file->text);
  const size_t offset = places.bytes(size_t(std::max<int64_t>(0, request.whole("offset", 0))));
  const At at = find_at(parsed.root, offset);
  size_t depth = 0;
  const Value::Member* block = block_at(at, &depth);
  size_t from = offset, to = offset;
  if (!at.members.empty()) {
    const Value::Member& innermost = *at.members.back();
    from = at.is_name ? innermost.place.offset : at.value->place.offset;
    to = at.is_name ? innermost.place.offset + innermost.name.size() + 2 : end_of(*at.value);
  }
  if (block) {
    const BlockType* type = loopwright::find_block(text_in(body_of(block->value, block->name, {}), "type"));
    const std::string_view key =
        at.members.size() > depth + 1 ? std::string_view(at.members[depth + 1]->name) : "";
    if (key == "type" && !at.is_name) {
      for (const auto& [name, entry] : all_blocks()) option(options, name, entry.info.sentence);
    } else if (key == "in" && !at.is_name) {
      add_sources(parsed.root, options);
    } else if (key == "in" && type) {
      for (const PortInfo& port : type->info.inputs) option(options, std::string(port.name), port.sentence);
    } else if (type && at.is_name) {
      add_settings(block->value, *type, options);
    } else if (type) {
      const std::vector<std::string> steps{std::string(key)};
      if (const ParameterInfo* info = find_parameter(type->info.parameters, steps))
        for (std::string_view choice : info->choices) option(options, std::string(choice), info->sentence);
    }
  } else if (!at.members.empty() && at.members.front()->name == "log") {
    add_sources(parsed.root, options);
  }
  return {{"from", places.units(from)}, {"to", places.units(to)}, {"options", std::move(options)}};
}

}  // namespace loopwright::studio
