#include "tools/experiment/data_file.h"
#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace loopwright {

namespace fs = std::filesystem;

std::string find_data_file(const std::string& named_in, const std::string& name,
                           std::vector<std::string>& tried) {
  std::vector<fs::path> places{fs::path(named_in).parent_path() / name};
  const char* variable = std::getenv("LOOPWRIGHT_DATA");
  const fs::path root = variable && *variable ? variable : "../shared/data";
  std::error_code missing;
  if (fs::is_directory(root, missing)) {
    places.push_back(root / name);
    std::error_code code;
    std::vector<fs::path> folders;
    for (const auto& entry : fs::directory_iterator(root, code))
      if (entry.is_directory(code)) folders.push_back(entry.path() / name);
    std::ranges::sort(folders);
    places.insert(places.end(), folders.begin(), folders.end());
  }
  for (const fs::path& place : places) {
    std::error_code code;
    if (fs::is_regular_file(place, code)) return place.string();
    tried.push_back(place.string());
  }
  return {};
}

}  // namespace loopwright
