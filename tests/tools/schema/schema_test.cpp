// The JSON Schemas: one for each kind of file, complete in themselves. schema_test.py holds them against
// files and readers.
#include <gmock/gmock.h>
#include <filesystem>
#include <nlohmann/json.hpp>
#include "engine/block/registry.h"
#include "engine/json/file_kind.h"
#include "tests/engine/diagram/diagram_folder.h"
#include "tools/schema/schema.h"

namespace loopwright::schema_test {
namespace {

using Json = nlohmann::json;

TEST(Schema, IsJsonOfTheSameDraftForEveryKind) {
  for (const SchemaKind& kind : schema_kinds()) {
    const Json schema = Json::parse(schema_of(kind.name));
    EXPECT_EQ(schema.at("$schema"), "https://json-schema.org/draft/2020-12/schema") << kind.name;
    EXPECT_EQ(kind.file_name, std::string(kind.name) + ".schema.json");
  }
  EXPECT_EQ(schema_kinds().front().name, "diagram");
  EXPECT_EQ(schema_of("unknown"), "");
}

void expect_definitions(const Json& part, const Json& schema) {
  if (part.is_object() && part.contains("$ref")) {
    const std::string pointer = part.at("$ref").get<std::string>().substr(1);
    EXPECT_TRUE(schema.contains(Json::json_pointer(pointer))) << part;
  }
  if (part.is_structured())
    for (const Json& inner : part) expect_definitions(inner, schema);
}

TEST(Schema, NeedsNoOtherFile) {
  for (const SchemaKind& kind : schema_kinds()) {
    const Json schema = Json::parse(schema_of(kind.name));
    expect_definitions(schema, schema);
  }
  EXPECT_FALSE(Json::parse(schema_of("sweep")).at("$defs").contains("Gain")) << "sweeps have no blocks";
  EXPECT_TRUE(Json::parse(schema_of("effect")).at("$defs").contains("Gain"));
}

TEST(Schema, DescribesEveryBlock) {
  const Json schema = Json::parse(schema_of("diagram"));
  for (const auto& [name, type] : all_blocks()) {
    ASSERT_TRUE(schema.at("$defs").contains(name)) << name;
    for (const ParameterInfo& parameter : type.info.parameters)
      EXPECT_TRUE(schema.at("$defs").at(name).at("properties").contains(std::string(parameter.name)))
          << name << "." << parameter.name;
  }
}

TEST(Schema, IsWrittenForEveryKindWithSettingsThatNameIt) {
  DiagramFolder folder;
  write_schemas(folder.path("deep/schemas"));
  const Json settings = Json::parse(editor_settings("deep/schemas"));
  ASSERT_EQ(settings.at("json.schemas").size(), schema_kinds().size());
  for (const Json& entry : settings.at("json.schemas"))
    EXPECT_TRUE(std::filesystem::exists(folder.path(entry.at("url").get<std::string>()))) << entry;
}

}  // namespace
}  // namespace loopwright::schema_test
