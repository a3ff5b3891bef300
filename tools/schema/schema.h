/// JSON Schemas (draft 2020-12) of every kind of file, for editors.
///
/// They are generated from what the readers of the files know: the descriptions of blocks and settings, and
/// the shapes of files (engine/json/file_shape.h).
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace loopwright {

/// A kind of file that has a schema.
struct SchemaKind {
  std::string_view name;       ///< "experiment"
  std::string_view file_name;  ///< "experiment.schema.json"
  /// The usual names of such files, as editors match them: "*.experiment.json". Empty: any name but the
  /// others.
  std::string_view pattern;
};

/// All kinds; "diagram" is the first.
const std::vector<SchemaKind>& schema_kinds();

/// The schema of files of this kind, as JSON; empty if there is no such kind.
std::string schema_of(std::string_view kind);

/// Writes the schemas of all kinds into a folder, which is created. Throws std::filesystem::filesystem_error
/// or std::runtime_error.
void write_schemas(const std::string& folder);

/// Visual Studio Code's settings that assign the schemas in a folder to files by their names. `folder`:
/// relative to the opened one.
std::string editor_settings(std::string_view folder);

}  // namespace loopwright
