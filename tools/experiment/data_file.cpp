#include "tools/experiment/data_file.h"
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include "engine/json/nearest_file.h"

namespace loopwright {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& file) {
  std::error_code code;
  return fs::is_regular_file(file, code);
}

/// Those with this name in the folders of a folder.
std::vector<std::string> in_folders_of(const fs::path& root, const std::string& name) {
  std::vector<std::string> found;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(root, code))
    if (entry.is_directory(code) && is_there(entry.path() / name))
      found.push_back((entry.path() / name).string());
  std::ranges::sort(found);
  return found;
}

}  // namespace

std::string find_data_file(const std::string& named_in, const std::string& name,
                           const std::function<Problem&(std::string message)>& problem) {
  const fs::path beside = fs::path(named_in).parent_path() / name;
  if (is_there(beside)) return beside.string();
  const char* const variable = std::getenv("LOOPWRIGHT_DATA");
  const fs::path root = variable ? variable : "";
  std::vector<std::string> found;
  if (!root.empty()) {
    if (is_there(root / name)) return (root / name).string();
    found = in_folders_of(root, name);
  }
  if (found.size() == 1) return found.front();
  if (found.size() > 1) {
    auto& p = problem(fmt::format("the data file \"{}\" is in several folders below $LOOPWRIGHT_DATA", name));
    p.expected = "the folder in the name, as in \"" + fs::relative(found.front(), root).string() + "\"";
    p.found = fmt::format("{}", fmt::join(found, ", "));
    return {};
  }
  auto& p = problem(fmt::format("the data file \"{}\" is not there", name));
  p.expected = beside.string() + (root.empty() ? "" : ", or below $LOOPWRIGHT_DATA");
  p.hint = nearest_file_hint(beside.string());
  if (p.hint.empty() && root.empty())
    p.hint = "the environment variable LOOPWRIGHT_DATA may name a folder of measurements";
  return {};
}

}  // namespace loopwright
