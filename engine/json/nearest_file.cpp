#include "engine/json/nearest_file.h"
#include <fmt/format.h>
#include <filesystem>
#include <vector>
#include "engine/json/problem.h"

namespace loopwright {

std::string nearest_file_hint(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr int most_files = 1000;  // limits the work in a folder of many records
  const fs::path wanted(path), folder = wanted.parent_path();
  std::error_code code;
  if (fs::exists(wanted, code)) return "";
  const std::string name = wanted.filename();
  // The extensions are the same and would make any two names similar: "loop.experiment.json" is "loop" here.
  const size_t stem = std::min(name.find('.', 1), name.size());
  const std::string extensions = name.substr(stem);
  std::vector<std::string> stems;
  int left = most_files;
  for (fs::directory_iterator at(folder.empty() ? "." : folder, code), end; !code && at != end && left-- > 0;
       at.increment(code)) {
    const std::string other = at->path().filename();
    const size_t length = std::min(other.find('.', 1), other.size());
    if (other.substr(length) == extensions) stems.push_back(other.substr(0, length));
  }
  const std::string nearest = nearest_name(name.substr(0, stem), stems);
  return nearest.empty() ? ""
                         : fmt::format("did you mean \"{}\"?", (folder / (nearest + extensions)).string());
}

}  // namespace loopwright
