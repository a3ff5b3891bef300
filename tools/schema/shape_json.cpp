#include "tools/schema/shape_json.h"
#include <cmath>
#include <set>

namespace loopwright {
namespace {

using Json = nlohmann::ordered_json;
using Kind = FileShape::Kind;

Json number(const FileShape& shape) {
  Json schema = {{"type", shape.kind == Kind::whole ? "integer" : "number"}};
  if (std::isfinite(shape.low)) schema[shape.low_is_open ? "exclusiveMinimum" : "minimum"] = shape.low;
  if (std::isfinite(shape.high)) schema["maximum"] = shape.high;
  return schema;
}

Json with_count(Json schema, const FileShape& shape, const char* fewest, const char* most) {
  if (shape.fewest > 0) schema[fewest] = shape.fewest;
  if (shape.most != FileShape::unlimited) schema[most] = shape.most;
  return schema;
}

Json object(const FileShape& shape) {
  Json schema = {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
  Json required = Json::array();
  for (const FileShape::Key& key : shape.keys) {
    schema["properties"][std::string(key.name)] = to_schema(key.shape);
    if (key.is_required) required.push_back(key.name);
  }
  if (!required.empty()) schema["required"] = required;
  return schema;
}

Json any_of(const std::vector<FileShape>& shapes) {
  Json alternatives = Json::array();
  for (const FileShape& shape : shapes) alternatives.push_back(to_schema(shape));
  return {{"anyOf", alternatives}};
}

/// As it is written without expressions and other files.
Json plain(const FileShape& shape) {
  switch (shape.kind) {
    case Kind::anything:
      break;
    case Kind::text:
      return with_count({{"type", "string"}}, shape, "minLength", "maxLength");
    case Kind::flag:
      return {{"type", "boolean"}};
    case Kind::number:
    case Kind::whole:
      return number(shape);
    case Kind::stated:
      return {{"anyOf",
               Json::array({number(shape), reference("number_and_unit"), reference("number_with_unit")})}};
    case Kind::computed:
      return {{"anyOf", Json::array({number(shape), reference("expression")})}};
    case Kind::choice:
      return {{"enum", shape.choices}};
    case Kind::list:
      return with_count({{"type", "array"}, {"items", to_schema(shape.parts.front())}}, shape, "minItems",
                        "maxItems");
    case Kind::by_name:
      return with_count({{"type", "object"}, {"additionalProperties", to_schema(shape.parts.front())}}, shape,
                        "minProperties", "maxProperties");
    case Kind::object:
      return object(shape);
    case Kind::either:
      return any_of(shape.parts);
    case Kind::block:
      return reference("block");
  }
  return Json::object();
}

/// With what an evaluation puts in its place.
Json evaluated(const FileShape& shape) {
  Json alternatives = Json::array({plain(shape)});
  const bool is_number = shape.kind == Kind::number || shape.kind == Kind::whole;
  const bool is_text = shape.kind == Kind::text;
  if (!is_number && !is_text && shape.kind != Kind::list && shape.kind != Kind::flag &&
      shape.kind != Kind::choice)
    return alternatives.front();
  if (!is_text) alternatives.push_back(reference("expression"));
  if (is_number) alternatives.push_back(reference("quantity"));
  alternatives.push_back(reference("in_file"));
  return {{"anyOf", alternatives}};
}

void collect_references(const Json& schema, const Json& definitions, std::set<std::string>& names) {
  constexpr std::string_view beginning = "#/$defs/";
  if (schema.is_object())
    if (const auto found = schema.find("$ref"); found != schema.end())
      if (const std::string name = found->get<std::string>().substr(beginning.size());
          names.insert(name).second)
        collect_references(definitions.at(name), definitions, names);
  if (schema.is_structured())
    for (const Json& part : schema) collect_references(part, definitions, names);
}

}  // namespace

Json reference(const std::string& name) { return {{"$ref", "#/$defs/" + name}}; }

Json to_schema(const FileShape& shape) {
  Json schema = shape.is_evaluated ? evaluated(shape) : plain(shape);
  if (!shape.sentence.empty()) schema["description"] = shape.sentence;
  if (!shape.default_text.empty()) {
    const Json value = Json::parse(shape.default_text, nullptr, false);
    if (!value.is_discarded()) schema["default"] = value;
  }
  return schema;
}

Json common_definitions() {
  const Json text = {{"type", "string"}};
  const auto with_unit = [&](Json value) -> Json {
    return {{"type", "object"},
            {"required", {"value", "unit"}},
            {"additionalProperties", false},
            {"properties", {{"value", std::move(value)}, {"unit", text}}}};
  };
  return {{"expression",
           {{"type", "string"},
            {"pattern", "^="},
            {"description", "An expression over parameters, \"=2*pi*40\""}}},
          {"in_file",
           {{"type", "object"},
            {"required", {"file", "name"}},
            {"additionalProperties", false},
            {"description", "A value of a JSON or MAT file"},
            {"properties",
             {{"file", {{"type", "string"}, {"description", "Its path, relative to this file"}}},
              {"name", {{"type", "string"}, {"description", "Name of the value: \"K\", \"poles.0.re\""}}}}}}},
          {"quantity", with_unit({{"anyOf", Json::array({{{"type", "number"}},
                                                         reference("expression"),
                                                         reference("quantity"),
                                                         reference("in_file")})}})},
          {"number_and_unit",
           {{"type", "string"},
            {"pattern", R"(^-?[0-9.]+([eE][-+]?[0-9]+)?( +\S|[^0-9. ]).*$)"},
            {"description", "A number and its unit: \"5 um\""}}},
          {"number_with_unit", with_unit({{"type", "number"}})}};
}

Json complete_schema(const std::string& title, const Json& schema, const Json& definitions) {
  std::set<std::string> names;
  collect_references(schema, definitions, names);
  Json complete = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
  complete.update(schema);
  for (const auto& [name, definition] : definitions.items())
    if (names.contains(name)) complete["$defs"][name] = definition;
  return complete;
}

}  // namespace loopwright
