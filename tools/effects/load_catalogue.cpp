#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <set>
#include "engine/json/reader.h"
#include "engine/record/installation.h"
#include "tools/effects/effect.h"
#include "tools/effects/effect_files.h"

namespace loopwright {
namespace {

/// Effects name each other, also those that a folder with a part of the catalogue leaves out. A name that no
/// effect has is a typing error.
void check_names(const std::vector<Effect>& effects, Problems& problems) {
  std::set<std::string> sorted;
  for (const Effect& effect : effects) sorted.insert(effect.name);
  Problems not_installed;  // then the loaded names are all that there are
  for (const std::string& folder : {installed_catalogue(), catalogue_folder()})
    for (const std::string& file : effect_files(folder, not_installed))
      sorted.insert(std::filesystem::path(file).stem().string());
  const std::vector<std::string> names(sorted.begin(), sorted.end());
  for (const Effect& effect : effects)
    for (const ConfusableEffect& other : effect.confusable)
      if (!sorted.contains(other.with)) {
        auto& p = problems.error(
            effect.blocks.place, "/confusable", "",
            fmt::format("\"{}\" is confusable with \"{}\", which is no effect", effect.name, other.with));
        KnownNames(names).explain(p, other.with);
      }
}

}  // namespace

std::vector<std::string> effect_files(const std::string& folder, Problems& problems) {
  namespace fs = std::filesystem;
  std::vector<std::string> files;
  std::error_code code;
  if (!fs::is_directory(folder, code)) {
    problems.error({}, "", "", fmt::format("the folder of effects \"{}\" is not there", folder)).hint =
        "the environment variable LOOPWRIGHT_EFFECTS may name it";
    return files;
  }
  for (const auto& entry : fs::directory_iterator(folder, code))
    if (entry.path().extension() == ".json") files.push_back(entry.path().string());
  if (files.empty())
    problems.error({}, "", "", fmt::format("the folder of effects \"{}\" contains none", folder)).hint =
        "an effect is a file of its own, as in diagrams/effects: see docs/effects.md";
  std::ranges::sort(files);
  return files;
}

std::string installed_catalogue() { return shared_file("diagrams/effects"); }

std::vector<Effect> load_catalogue(const std::vector<std::string>& folders, Problems& problems) {
  std::vector<Effect> catalogue;
  for (const std::string& folder : folders)
    for (const std::string& file : effect_files(folder, problems)) {
      std::vector<Effect> effects = load_effect(file, problems);
      if (effects.empty()) continue;
      std::erase_if(catalogue, [&](const Effect& e) { return e.name == effects.front().name; });
      std::ranges::move(effects, std::back_inserter(catalogue));
    }
  std::ranges::stable_sort(catalogue, {}, [](const Effect& e) { return e.name; });
  if (!problems.has_errors()) check_names(catalogue, problems);
  return catalogue;
}

}  // namespace loopwright
