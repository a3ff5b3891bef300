/// The shipped diagrams in a folder of their own.
#pragma once
#include <vector>
#include "engine/json/file_kind.h"
#include "tests/tools/studio/session/studio_folder.h"
#include "tools/studio/session/folder.h"
#include "where.h"

namespace loopwright::studio {

/// Copies them, and returns their paths below the folder.
inline std::vector<std::string> shipped_diagrams(const StudioFolder& folder) {
  namespace fs = std::filesystem;
  fs::copy(LOOPWRIGHT_SOURCE "/diagrams", folder.path("diagrams"), fs::copy_options::recursive);
  fs::create_directories(folder.path("hw"));
  fs::copy(LOOPWRIGHT_SOURCE "/hw/devices", folder.path("hw/devices"), fs::copy_options::recursive);
  std::vector<std::string> paths;
  for (const Folder::File& file : Folder(folder.path()).files()) {
    Problems problems;
    if (file.path.starts_with("diagrams/") && file.path.ends_with(".json") &&
        kind_of_file(folder.path(file.path), problems) == FileKind::diagram)
      paths.push_back(file.path);
  }
  return paths;
}

}  // namespace loopwright::studio
