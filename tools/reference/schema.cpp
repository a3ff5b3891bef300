#include <cmath>
#include <nlohmann/json.hpp>
#include "engine/plan/block_settings.h"
#include "tools/reference/reference.h"

namespace loopwright {
namespace {

using Json = nlohmann::ordered_json;

std::string described(const ParameterInfo& p) {
  std::string text(p.sentence);
  if (!p.unit.empty() && p.unit != unit_of_output) text += " [" + std::string(p.unit) + "]";
  return text;
}

Json type_schema(const ParameterInfo& p);

Json object_schema(const std::vector<ParameterInfo>& fields) {
  Json schema = {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
  Json required = Json::array();
  for (const ParameterInfo& field : fields) {
    schema["properties"][std::string(field.name)] = type_schema(field);
    if (!field.has_default) required.push_back(field.name);
  }
  if (!required.empty()) schema["required"] = required;
  return schema;
}

/// A number, an expression over parameters, or a number with a unit.
Json number_schema(const ParameterInfo& p, const char* type) {
  Json number = {{"type", type}};
  if (std::isfinite(p.low)) number[p.low_is_open ? "exclusiveMinimum" : "minimum"] = p.low;
  if (std::isfinite(p.high)) number["maximum"] = p.high;
  return {{"anyOf", Json::array({number,
                                 {{"$ref", "#/$defs/expression"}},
                                 {{"$ref", "#/$defs/quantity"}},
                                 {{"$ref", "#/$defs/in_file"}}})}};
}

Json type_schema(const ParameterInfo& p) {
  Json schema;
  switch (p.kind) {
    case ParameterKind::number:
      schema = number_schema(p, "number");
      break;
    case ParameterKind::whole:
      schema = number_schema(p, "integer");
      break;
    case ParameterKind::flag:
      schema = {{"type", "boolean"}};
      break;
    case ParameterKind::text:
    case ParameterKind::file:
      schema = {{"type", "string"}};
      break;
    case ParameterKind::choice:
      schema = {{"enum", p.choices}};
      break;
    case ParameterKind::list:
      schema = {{"anyOf", Json::array({{{"type", "array"}, {"items", type_schema(p.element.front())}},
                                       {{"$ref", "#/$defs/expression"}},
                                       {{"$ref", "#/$defs/in_file"}}})}};
      break;
    case ParameterKind::by_name:
      schema = {{"type", "object"}, {"additionalProperties", type_schema(p.element.front())}};
      break;
    case ParameterKind::object:
      schema = object_schema(p.fields);
      break;
  }
  if (!p.sentence.empty()) schema["description"] = described(p);
  if (!p.default_text.empty()) {
    const Json value = Json::parse(p.default_text, nullptr, false);
    if (!value.is_discarded()) schema["default"] = value;
  }
  return schema;
}

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
  Json schema = object_schema(info.parameters);
  Json properties = {{"type", {{"const", info.type}, {"description", info.sentence}}},
                     {"in", wires_schema(info)},
                     {"description", {{"type", "string"}}}};
  if (!info.is_continuous) {
    const ParameterInfo time{"sample_time", "s", "Time between samples", ParameterKind::number, 0,
                             infinity,      true};
    properties["sample_time"] = type_schema(time);
    properties["sample_offset"] = {{"description", "Time of the first sample [s]"},
                                   {"anyOf", Json::array({{{"type", "number"}, {"minimum", 0}},
                                                          {{"$ref", "#/$defs/expression"}},
                                                          {{"$ref", "#/$defs/quantity"}}})}};
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

Json solver_schema() {
  const Json number = {{"anyOf", Json::array({{{"type", "number"}},
                                              {{"$ref", "#/$defs/expression"}},
                                              {{"$ref", "#/$defs/quantity"}}})}};
  Json properties = {{"method", {{"enum", {"euler", "heun", "rk4", "dopri5", "cvode-bdf", "cvode-adams"}}}},
                     {"algebraic_loops", {{"enum", {"error", "solve"}}}},
                     {"seed", {{"type", "integer"}, {"minimum", 0}}}};
  for (const char* name :
       {"start", "stop", "step", "maximum_step", "relative_tolerance", "absolute_tolerance", "record_step"})
    properties[name] = number;
  return {{"type", "object"}, {"additionalProperties", false}, {"properties", properties}};
}

/// Of a subdiagram that is enabled.
Json while_disabled_schema() {
  const Json choice = {{"enum", {"hold", "reset"}}, {"default", "hold"}};
  return {{"anyOf", Json::array({choice,
                                 {{"type", "object"},
                                  {"additionalProperties", false},
                                  {"properties", {{"states", choice}, {"outputs", choice}}}}})},
          {"description", "What becomes of states and outputs while it does not run"}};
}

Json figures_schema() {
  return {{"type", "object"},
          {"description", "A logged signal and the logged reference that it is to follow"},
          {"required", {"signal", "reference"}},
          {"additionalProperties", false},
          {"properties",
           {{"signal", {{"type", "string"}}},
            {"reference", {{"type", "string"}}},
            {"band", {{"description", "Within it the signal has settled; 2 % of the last move when left out"}}}}}};
}

}  // namespace

std::string diagram_schema() {
  Json definitions = {
      {"wire",
       {{"type", "string"}, {"description", "block.output, block.output[0], or an input of this diagram"}}},
      {"wires",
       {{"anyOf", Json::array({{{"$ref", "#/$defs/wire"}},
                               {{"type", "array"}, {"items", {{"$ref", "#/$defs/wire"}}}}})}}},
      {"expression",
       {{"type", "string"},
        {"pattern", "^="},
        {"description", "An expression over parameters, \"=2*pi*40\""}}},
      {"in_file",
       {{"type", "object"},
        {"required", {"file", "name"}},
        {"additionalProperties", false},
        {"description", "A value of a JSON file"},
        {"properties",
         {{"file", {{"type", "string"}, {"description", "Its path, relative to this file"}}},
          {"name", {{"type", "string"}, {"description", "Name of the value: \"K\", \"poles.0.re\""}}}}}}},
      {"quantity",
       {{"type", "object"},
        {"required", {"value", "unit"}},
        {"additionalProperties", false},
        {"properties",
         {{"value", {{"anyOf", Json::array({{{"type", "number"}}, {{"$ref", "#/$defs/expression"}}})}}},
          {"unit", {{"type", "string"}}}}}}},
      {"solver", solver_schema()}};
  Json choices = Json::array();
  for (const auto& [name, type] : all_blocks()) {
    definitions[name] = block_schema(type.info);
    choices.push_back({{"if", {{"properties", {{"type", {{"const", name}}}}}, {"required", {"type"}}}},
                       {"then", {{"$ref", "#/$defs/" + name}}}});
  }
  Json types = Json::array();
  for (const auto& [name, type] : all_blocks()) types.push_back(name);
  definitions["block"] = {
      {"type", "object"},
      {"properties",
       {{"type", {{"enum", types}}},
        {"diagram",
         {{"anyOf", Json::array({{{"type", "string"}}, {{"$ref", "#/$defs/diagram"}}})},
          {"description", "A subdiagram: its file, relative to this one, or the diagram itself"}}},
        {"enabled_by",
         {{"$ref", "#/$defs/wire"}, {"description", "Of a subdiagram: it runs while this signal is true"}}},
        {"while_disabled", while_disabled_schema()},
        {"triggered_by",
         {{"$ref", "#/$defs/wire"},
          {"description", "Of a subdiagram: it runs at the edges of this sampled signal"}}},
        {"edge",
         {{"enum", {"rising", "falling", "either"}}, {"description", "At which edges it is triggered"}}},
        {"variants", {{"type", "object"}, {"additionalProperties", {{"$ref", "#/$defs/block"}}}}},
        {"variant", {{"type", "string"}}}}},
      {"anyOf",
       Json::array({{{"required", {"type"}}}, {{"required", {"diagram"}}}, {{"required", {"variants"}}}})},
      {"allOf", choices}};
  const Json parameter = {{"anyOf", Json::array({{{"type", {"number", "string", "boolean", "array"}}},
                                                 {{"$ref", "#/$defs/in_file"}},
                                                 {{"type", "object"},
                                                  {"required", {"value"}},
                                                  {"additionalProperties", false},
                                                  {"properties",
                                                   {{"value", Json::object()},
                                                    {"unit", {{"type", "string"}}},
                                                    {"description", {{"type", "string"}}}}}}})}};
  const Json input_schema = {
      {"anyOf", Json::array({{{"type", "string"}, {"description", "Its unit"}},
                             {{"type", "object"},
                              {"additionalProperties", false},
                              {"properties",
                               {{"unit", {{"type", "string"}}}, {"description", {{"type", "string"}}}}}}})}};
  const Json output_schema = {{"anyOf", Json::array({{{"$ref", "#/$defs/wire"}},
                                                     {{"type", "object"},
                                                      {"required", {"source"}},
                                                      {"additionalProperties", false},
                                                      {"properties",
                                                       {{"source", {{"$ref", "#/$defs/wire"}}},
                                                        {"unit", {{"type", "string"}}},
                                                        {"description", {{"type", "string"}}}}}}})}};
  definitions["diagram"] = {
      {"type", "object"},
      {"required", {"blocks"}},
      {"properties",
       {{"$schema", {{"type", "string"}, {"description", "This schema, for editors"}}},
        {"loopwright", {{"const", 1}}},
        {"title", {{"type", "string"}}},
        {"description", {{"type", "string"}}},
        {"parameters", {{"type", "object"}, {"additionalProperties", parameter}}},
        {"solver", {{"$ref", "#/$defs/solver"}}},
        {"inputs", {{"type", "object"}, {"additionalProperties", input_schema}}},
        {"outputs", {{"type", "object"}, {"additionalProperties", output_schema}}},
        {"blocks", {{"type", "object"}, {"additionalProperties", {{"$ref", "#/$defs/block"}}}}},
        {"log", {{"type", "array"}, {"items", {{"type", "string"}}}}},
        {"figures", {{"type", "array"}, {"items", figures_schema()}}}}},
      {"additionalProperties", false}};
  Json schema = definitions["diagram"];
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["title"] = "Loopwright diagram";
  schema["required"] = {"loopwright", "blocks"};
  schema["$defs"] = definitions;
  return schema.dump(2) + "\n";
}

}  // namespace loopwright
