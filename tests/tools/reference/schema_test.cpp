// The JSON Schema: well formed, complete, and satisfied by every diagram in the repository.
#include <gtest/gtest.h>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include "engine/block/registry.h"
#include "tools/reference/reference.h"
#include "where.h"

namespace loopwright {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

/// The part of JSON Schema (draft 2020-12) that diagram_schema() uses. An unknown keyword fails the test.
class Validator {
 public:
  explicit Validator(const Json& schema) : root_(schema) {}

  /// The error of a value, "" if there is none.
  std::string fault(const Json& schema, const Json& value, const std::string& at = "") const {
    for (const auto& [key, rule] : schema.items())
      if (const std::string text = fault_by(key, rule, schema, value, at); !text.empty()) return text;
    return "";
  }
  std::string fault(const Json& value) const { return fault(root_, value); }

 private:
  static bool is_type(const std::string& type, const Json& v) {
    return type == "object"    ? v.is_object()
           : type == "array"   ? v.is_array()
           : type == "string"  ? v.is_string()
           : type == "boolean" ? v.is_boolean()
           : type == "integer" ? v.is_number() && v.get<double>() == double(int64_t(v.get<double>()))
                               : type == "number" && v.is_number();
  }
  std::string fault_by(const std::string& key, const Json& rule, const Json& schema, const Json& value,
                       const std::string& at) const {
    const auto need = [&](bool good, const std::string& what) {
      return good ? "" : at + ": " + what + " in " + value.dump().substr(0, 120);
    };
    if (key == "$schema" || key == "title" || key == "description" || key == "default" || key == "$defs" ||
        key == "then")
      return "";
    if (key == "type") {
      bool any = false;
      for (const Json& type : rule.is_array() ? rule : Json::array({rule})) any |= is_type(type, value);
      return need(any, "not of type " + rule.dump());
    }
    if (key == "const") return need(value == rule, "not " + rule.dump());
    if (key == "enum")
      return need(std::find(rule.begin(), rule.end(), value) != rule.end(),
                  "none of " + rule.dump().substr(0, 80));
    if (key == "minimum") return need(!value.is_number() || value >= rule, "below " + rule.dump());
    if (key == "maximum") return need(!value.is_number() || value <= rule, "above " + rule.dump());
    if (key == "exclusiveMinimum")
      return need(!value.is_number() || value > rule, "not above " + rule.dump());
    if (key == "pattern")
      return need(!value.is_string() ||
                      std::regex_search(value.get<std::string>(), std::regex(rule.get<std::string>())),
                  "no match");
    if (key == "required") {
      for (const Json& name : rule)
        if (value.is_object() && !value.contains(name)) return need(false, "no " + name.dump());
      return "";
    }
    if (key == "$ref")
      return fault(root_.at(Json::json_pointer(rule.get<std::string>().substr(1))), value, at);
    if (key == "allOf") return first_fault(rule, value, at);
    if (key == "anyOf") {
      std::string last;
      for (const Json& one : rule)
        if ((last = fault(one, value, at)).empty()) return "";
      return last;
    }
    if (key == "if") return fault(rule, value).empty() ? fault(schema.at("then"), value, at) : "";
    if (key == "properties") {
      for (const auto& [name, inner] : rule.items())
        if (value.is_object() && value.contains(name))
          if (const std::string text = fault(inner, value.at(name), at + "/" + name); !text.empty())
            return text;
      return "";
    }
    if (key == "additionalProperties") {
      if (!value.is_object()) return "";
      for (const auto& [name, member] : value.items()) {
        if (schema.contains("properties") && schema.at("properties").contains(name)) continue;
        if (rule == false) return at + ": unknown key " + name;
        if (rule.is_object())
          if (const std::string text = fault(rule, member, at + "/" + name); !text.empty()) return text;
      }
      return "";
    }
    if (key == "minItems")
      return need(!value.is_array() || value.size() >= rule.get<size_t>(),
                  "fewer than " + rule.dump() + " items");
    if (key == "items") {
      for (size_t i = 0; value.is_array() && i < value.size(); ++i)
        if (const std::string text = fault(rule, value[i], at + "/" + std::to_string(i)); !text.empty())
          return text;
      return "";
    }
    return at + ": the schema uses the keyword " + key + ", which this test does not know";
  }
  std::string first_fault(const Json& all, const Json& value, const std::string& at) const {
    for (const Json& one : all)
      if (const std::string text = fault(one, value, at); !text.empty()) return text;
    return "";
  }
  const Json& root_;
};

TEST(Schema, IsJsonAndDescribesEveryBlock) {
  const Json schema = Json::parse(diagram_schema());
  EXPECT_EQ(schema.at("$schema"), "https://json-schema.org/draft/2020-12/schema");
  for (const auto& [name, type] : all_blocks()) {
    ASSERT_TRUE(schema.at("$defs").contains(name)) << name;
    for (const ParameterInfo& parameter : type.info.parameters)
      EXPECT_TRUE(schema.at("$defs").at(name).at("properties").contains(std::string(parameter.name)))
          << name << "." << parameter.name;
  }
}

TEST(Schema, AgreesWithEveryDiagramOfTheRepository) {
  const Json schema = Json::parse(diagram_schema());
  int diagrams = 0;
  for (const auto& entry : fs::recursive_directory_iterator(LOOPWRIGHT_SOURCE "/diagrams")) {
    if (entry.path().extension() != ".json") continue;
    const Json diagram = Json::parse(std::ifstream(entry.path()));
    if (!diagram.contains("blocks") || diagram.contains("attach")) continue;  // experiments, effects
    EXPECT_EQ(Validator(schema).fault(diagram), "") << entry.path();
    ++diagrams;
  }
  EXPECT_GE(diagrams, 70);
}

TEST(Schema, RefusesWhatTheProgramRefuses) {
  const Json schema = Json::parse(diagram_schema());
  const auto fault = [&](const char* block) {
    return Validator(schema).fault(
        Json::parse(R"({"loopwright": 1, "blocks": {"b": )" + std::string(block) + "}}"));
  };
  EXPECT_EQ(fault(R"({"type": "Gain", "gain": 2, "in": {"u": "c.y"}})"), "");
  EXPECT_NE(fault(R"({"type": "Gian", "gain": 2, "in": {"u": "c.y"}})"), "");
  EXPECT_NE(fault(R"({"type": "Gain", "gian": 2, "in": {"u": "c.y"}})"), "");
  EXPECT_NE(fault(R"({"type": "Gain", "gain": 2, "in": {"v": "c.y"}})"), "");
  EXPECT_NE(fault(R"({"type": "Mass", "mass": -2, "in": {"force": "c.y"}})"), "");
  EXPECT_NE(fault(R"({"type": "UnitDelay", "in": {"u": "c.y"}})"), "") << "no sample time";
  EXPECT_NE(fault(R"({"gain": 2})"), "");
  EXPECT_NE(Validator(schema).fault(Json::parse(R"({"loopwright": 2, "blocks": {}})")), "");
  EXPECT_NE(Validator(schema).fault(Json::parse(R"({"loopwright": 1, "blocks": {}, "bloks": {}})")), "");
  EXPECT_NE(
      Validator(schema).fault(Json::parse(R"({"loopwright": 1, "blocks": {}, "solver": {"method": "rk5"}})")),
      "");
}

TEST(Schema, KnowsBothWaysToWriteAnOutput) {
  const Json schema = Json::parse(diagram_schema());
  EXPECT_EQ(
      Validator(schema).fault(Json::parse(
          R"({"loopwright": 1, "blocks": {}, "outputs": {"a": "b.y", "c": {"source": "b.y", "unit": "N"}}})")),
      "");
  EXPECT_TRUE(diagram_schema().find("\"source\"") != std::string::npos);
}

}  // namespace
}  // namespace loopwright
