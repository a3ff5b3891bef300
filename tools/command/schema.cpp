#include "tools/schema/schema.h"
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <filesystem>
#include "tools/command/command.h"

namespace loopwright {
namespace {

struct SchemaArguments {
  std::string kind = "diagram", folder;
};

[[noreturn]] void refuse(std::string message, std::string expected, std::string hint) {
  Problems problems;
  auto& problem = problems.error({}, "", "", std::move(message));
  problem.expected = std::move(expected), problem.hint = std::move(hint);
  throw InputError(std::move(problems));
}

int print(const std::string& kind) {
  const std::string schema = schema_of(kind);
  if (schema.empty()) {
    std::vector<std::string> names;
    for (const SchemaKind& known : schema_kinds()) names.emplace_back(known.name);
    const std::string near = nearest_name(kind, names);
    refuse(fmt::format("there is no kind of file \"{}\"", kind),
           fmt::format("one of {}", fmt::join(names, ", ")),
           near.empty() ? "" : fmt::format("did you mean \"{}\"?", near));
  }
  answer_data(schema);
  return done;
}

int write_all(const std::string& folder) {
  try {
    write_schemas(folder);
  } catch (const std::filesystem::filesystem_error& error) {
    refuse(fmt::format("\"{}\" cannot be created: {}", folder, error.code().message()),
           "--output with a folder that can be written", "");
  }
  answer("{}: the schemas of {} kinds of files\n", folder, schema_kinds().size());
  return done;
}

}  // namespace

void add_schema(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("schema", "Print the JSON Schema of a kind of file, for editors");
  auto a = std::make_shared<SchemaArguments>();
  CLI::Option* const kind =
      command->add_option("kind", a->kind, "diagram, experiment, sweep, training, effect, device or model")
          ->capture_default_str();
  command->add_option("-o,--output", a->folder, "Write those of all kinds into this folder, KIND.schema.json")
      ->type_name("FOLDER")
      ->excludes(kind);
  command->callback(
      [=] { choose([=] { return a->folder.empty() ? print(a->kind) : write_all(a->folder); }); });
}

}  // namespace loopwright
