#include "tools/schema/schema.h"
#include <array>
#include <filesystem>
#include "blocks/learning/model_shape.h"
#include "engine/json/file_kind.h"
#include "engine/record/atomic_file.h"
#include "hw/drivers.h"
#include "tools/effects/effect_shape.h"
#include "tools/experiment/experiment_shape.h"
#include "tools/gp/training_shape.h"
#include "tools/schema/diagram_schema.h"
#include "tools/schema/shape_json.h"
#include "tools/sweep/sweep_shape.h"

namespace loopwright {
namespace {

using Json = nlohmann::ordered_json;

struct KindOfFile {
  SchemaKind names;
  FileKind kind;
  FileShape (*shape)();  ///< null: of a diagram
};

constexpr std::array<KindOfFile, 7> kinds = {{
    {{"diagram", "diagram.schema.json", ""}, FileKind::diagram, nullptr},
    {{"experiment", "experiment.schema.json", "*.experiment.json"}, FileKind::experiment, &experiment_shape},
    {{"sweep", "sweep.schema.json", "*.sweep.json"}, FileKind::sweep, &sweep_shape},
    {{"training", "training.schema.json", "*.training.json"}, FileKind::training, &training_shape},
    {{"effect", "effect.schema.json", "**/effects/*.json"}, FileKind::effect, &any_effect_shape},
    {{"device", "device.schema.json", "*.device.json"}, FileKind::device, &hw::device_file_shape},
    {{"model", "model.schema.json", "*.model.json"}, FileKind::model, &model_shape},
}};
static_assert(kinds.size() == size_t(FileKind::model),
              "every kind of file but `unknown`, which is the first");

}  // namespace

const std::vector<SchemaKind>& schema_kinds() {
  static const std::vector<SchemaKind> names = [] {
    std::vector<SchemaKind> list;
    for (const KindOfFile& kind : kinds) list.push_back(kind.names);
    return list;
  }();
  return names;
}

std::string schema_of(std::string_view name) {
  for (const KindOfFile& kind : kinds) {
    if (kind.names.name != name) continue;
    const Json schema = kind.shape ? to_schema(kind.shape()) : diagram_file_schema();
    const std::string article(with_article(kind.kind));  // "an experiment"
    const std::string title = "Loopwright: " + article.substr(article.find(' ') + 1);
    return complete_schema(title, schema, diagram_definitions()).dump(2) + "\n";
  }
  return "";
}

void write_schemas(const std::string& folder) {
  std::filesystem::create_directories(folder);
  for (const SchemaKind& kind : schema_kinds())
    write_file((std::filesystem::path(folder) / kind.file_name).string(), schema_of(kind.name));
}

std::string editor_settings(std::string_view folder) {
  const auto entry = [&](Json patterns, const SchemaKind& kind) {
    Json object = Json::object();
    object["fileMatch"] = std::move(patterns);
    object["url"] = "./" + std::string(folder) + "/" + std::string(kind.file_name);
    return object;
  };
  // Editors apply every schema that matches: files of other kinds are excluded from the diagrams.
  Json of_diagrams = Json::array({"*.json", "!.vscode/*.json", "!*.schema.json"}), list = Json::array();
  for (const SchemaKind& kind : schema_kinds())
    if (!kind.pattern.empty()) of_diagrams.push_back("!" + std::string(kind.pattern));
  for (const SchemaKind& kind : schema_kinds())
    list.push_back(entry(kind.pattern.empty() ? of_diagrams : Json::array({kind.pattern}), kind));
  Json settings = Json::object();
  settings["json.schemas"] = std::move(list);
  return settings.dump(2) + "\n";
}

}  // namespace loopwright
