#include "tools/schema/diagram_schema.h"
#include "engine/block/parameter_shape.h"
#include "engine/block/registry.h"
#include "engine/diagram/figures.h"
#include "engine/diagram/solver_settings.h"
#include "engine/plan/block_settings.h"
#include "tools/schema/shape_json.h"

namespace loopwright {
namespace {

using Json = nlohmann::ordered_json;

Json wires_schema(const BlockInfo& info) {
  Json in = {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
  Json required = Json::array();
  for (const PortInfo& port : info.inputs) {
    if (port.shape == PortInfo::Shape::named) {
      in["additionalProperties"] = {{"$ref", "#/$defs/wire"}, {"description", port.sentence}};
      continue;
    }
    Json wire = {{"$ref", port.shape == PortInfo::Shape::many ? "#/$defs/wires" : "#/$defs/wire"}};
    wire["description"] =
        std::string(port.sentence) + (port.unit.empty() ? "" : " [" + std::string(port.unit) + "]");
    in["properties"][std::string(port.name)] = wire;
    if (!port.is_optional) required.push_back(port.name);
  }
  if (!required.empty()) in["required"] = required;
  return in;
}

Json block_schema(const BlockInfo& info) {
  Json schema = to_schema(shape_of(info.parameters, Writing::evaluated));
  Json properties = {{"type", {{"const", info.type}, {"description", info.sentence}}},
                     {"in", wires_schema(info)},
                     {"description", {{"type", "string"}}}};
  if (!info.is_continuous) {
    FileShape time = shapes::number(0);
    time.is_evaluated = true;
    time.sentence = "Time of the first sample [s]";
    properties["sample_offset"] = to_schema(time);
    time.low_is_open = true;
    time.sentence = "Time between samples [s]";
    properties["sample_time"] = to_schema(time);
  }
  for (auto& [name, parameter] : schema["properties"].items()) properties[name] = parameter;
  if (takes_numbers_by_element(info))
    for (const ParameterInfo& parameter : info.parameters)
      if (parameter.kind == ParameterKind::number) {
        Json& number = properties[std::string(parameter.name)];
        const Json one = {{"anyOf", number["anyOf"]}};
        number["anyOf"].push_back({{"type", "array"}, {"minItems", 1}, {"items", one}});
      }
  schema["properties"] = properties;
  Json required = Json::array({"type"});
  if (info.is_sampled) required.push_back("sample_time");
  if (schema.contains("required"))
    for (auto& name : schema["required"]) required.push_back(name);
  schema["required"] = required;
  return schema;
}

Json described(Json schema, const char* sentence) {
  schema["description"] = sentence;
  return schema;
}

Json object(Json properties, Json required = Json::array()) {
  Json schema = {{"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
  if (!required.empty()) schema["required"] = std::move(required);
  return schema;
}

Json by_name(Json item) { return {{"type", "object"}, {"additionalProperties", std::move(item)}}; }

/// `then` applies where the key is present; with a value, where it has this value.
Json where(const std::string& key, const std::string& then, const Json& value = nullptr) {
  Json condition = {{"required", Json::array({key})}};
  if (!value.is_null()) condition["properties"][key] = {{"const", value}};
  return {{"if", condition}, {"then", reference(then)}};
}

/// Of a subdiagram that is enabled.
Json while_disabled_schema() {
  const Json choice = {{"enum", {"hold", "reset"}}, {"default", "hold"}};
  return {{"anyOf", Json::array({choice, object({{"states", choice}, {"outputs", choice}})})},
          {"description", "What becomes of states and outputs while it does not run"}};
}

Json subdiagram_schema() {
  const Json file_or_diagram = {
      {"anyOf", Json::array({{{"type", "string"}, {"minLength", 1}}, reference("diagram")})}};
  return object(
      {{"diagram", described(file_or_diagram, "Its file, relative to this one, or the diagram itself")},
       {"parameters", described(by_name(reference("value")), "In place of those of the subdiagram")},
       {"in", by_name(reference("wires"))},
       {"description", {{"type", "string"}}},
       {"enabled_by", described(reference("wire"), "It runs while this signal is true")},
       {"while_disabled", while_disabled_schema()},
       {"triggered_by", described(reference("wire"), "It runs at the edges of this sampled signal")},
       {"edge",
        {{"enum", {"rising", "falling", "either"}}, {"description", "At which edges it is triggered"}}}},
      Json::array({"diagram"}));
}

Json variants_schema() {
  Json variants = by_name(reference("block"));
  variants["minProperties"] = 1;
  return object({{"variants", described(std::move(variants), "One of them takes the place of the block")},
                 {"variant", {{"type", "string"}, {"description", "The name of the active one"}}},
                 {"in", by_name(reference("wires"))},
                 {"description", {{"type", "string"}}}},
                Json::array({"variants"}));
}

/// A block of any type; the schemas of the types are definitions of their own.
Json any_block_schema() {
  Json types = Json::array(),
       cases = Json::array({where("diagram", "subdiagram"), where("variants", "variants")});
  for (const auto& [name, type] : all_blocks()) {
    types.push_back(name);
    cases.push_back(where("type", name, name));
  }
  const Json any = {{"type", "object"}, {"properties", {{"type", {{"enum", types}}}}}};
  Json schema = any;
  schema["anyOf"] =
      Json::array({{{"required", {"type"}}}, {{"required", {"diagram"}}}, {{"required", {"variants"}}}});
  schema["allOf"] = cases;
  return schema;
}

/// A number, text, flag, or a list of them; each may be taken from another file.
Json value_schema() {
  return {{"anyOf", Json::array({{{"type", {"number", "string", "boolean"}}},
                                 {{"type", "array"}, {"items", reference("value")}},
                                 reference("quantity"),
                                 reference("in_file")})}};
}

Json parameter_schema() {
  const Json written = object(
      {{"value", reference("value")}, {"unit", {{"type", "string"}}}, {"description", {{"type", "string"}}}},
      Json::array({"value"}));
  return {{"anyOf", Json::array({reference("value"), written})}};
}

Json port_schemas(const char* key) {
  Json properties = {{"unit", {{"type", "string"}}}, {"description", {{"type", "string"}}}};
  if (std::string_view(key) == "inputs")
    return by_name(
        {{"anyOf", Json::array({{{"type", "string"}, {"description", "Its unit"}}, object(properties)})}});
  properties["source"] = reference("wire");
  return by_name({{"anyOf", Json::array({reference("wire"), object(properties, Json::array({"source"}))})}});
}

Json diagram_schema() {
  return object(
      {{"$schema", {{"type", "string"}, {"description", "The JSON Schema of this file, for editors"}}},
       {"loopwright", {{"const", 1}, {"description", "Version of the format"}}},
       {"title", {{"type", "string"}}},
       {"description", {{"type", "string"}}},
       {"parameters", by_name(parameter_schema())},
       {"solver", reference("solver")},
       {"inputs", port_schemas("inputs")},
       {"outputs", port_schemas("outputs")},
       {"blocks", by_name(reference("block"))},
       {"log", {{"type", "array"}, {"items", {{"type", "string"}}}}},
       {"figures", {{"type", "array"}, {"items", to_schema(figure_shape())}}}});
}

}  // namespace

Json diagram_definitions() {
  Json definitions = common_definitions();
  definitions["wire"] = {{"type", "string"},
                         {"description", "block.output, block.output[0], or an input of this diagram"}};
  definitions["wires"] = {
      {"anyOf", Json::array({reference("wire"), {{"type", "array"}, {"items", reference("wire")}}})}};
  definitions["value"] = value_schema();
  definitions["solver"] = to_schema(solver_shape());
  definitions["diagram"] = diagram_schema();
  definitions["subdiagram"] = subdiagram_schema();
  definitions["variants"] = variants_schema();
  definitions["block"] = any_block_schema();
  for (const auto& [name, type] : all_blocks()) definitions[name] = block_schema(type.info);
  return definitions;
}

Json diagram_file_schema() {
  Json schema = diagram_schema();
  schema["required"] = Json::array({"loopwright"});
  return schema;
}

}  // namespace loopwright
