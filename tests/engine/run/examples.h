/// The diagrams in diagrams/examples, one for every block, without other files such as NAME.model.json.
#pragma once
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>
#include "where.h"

namespace loopwright {

inline std::vector<std::string> example_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(LOOPWRIGHT_SOURCE "/diagrams/examples"))
    if (entry.path().extension() == ".json" && !entry.path().stem().has_extension())
      files.push_back(entry.path().string());
  std::ranges::sort(files);
  return files;
}

}  // namespace loopwright
