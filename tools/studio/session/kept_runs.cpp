#include "tools/studio/session/kept_runs.h"
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include "engine/json/reader.h"
#include "engine/record/recording_file.h"

namespace loopwright::studio {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view runs_folder = ".loopwright/runs/";

std::string file_of(const std::string& kept_as, std::string_view suffix) {
  return std::string(runs_folder) + kept_as + std::string(suffix);
}

Json load_json(const LoadOptions& load) {
  Json set = Json::array();
  for (const auto& [name, value] : load.set) set.push_back({name, value});
  return {{"set", std::move(set)}, {"variants", load.variants}};
}
LoadOptions load_of(const Json& json) {
  LoadOptions load;
  for (const Json& entry : json.at("set")) load.set.emplace_back(entry.at(0), entry.at(1));
  load.variants = json.at("variants").get<std::map<std::string, std::string>>();
  return load;
}

std::shared_ptr<StoredRun> read_run(const std::string& text) {
  try {
    auto run = std::make_shared<StoredRun>();
    run->facts = Json::parse(text);
    run->path = run->facts.at("path").get<std::string>();
    run->load = load_of(run->facts.at("load"));
    for (const Json& name : run->facts.at("held")) run->held.insert(name.get<std::string>());
    for (const char* key : {"name", "note", "when", "hash", "command"}) run->facts.at(key).get<std::string>();
    if (!run->facts.at("set").is_object() || !run->facts.at("merit").is_array()) return nullptr;
    run->facts.erase("load"), run->facts.erase("held");
    return run;
  } catch (const Json::exception&) {  // of another program, or of an earlier version
    return nullptr;
  }
}

}  // namespace

std::string keep_run(const Folder& folder, const StoredRun& run, const std::string& kept_as) {
  folder.make_own_folder("runs");
  std::string name = kept_as;
  const std::string hash = run.facts["hash"].get<std::string>();
  for (int i = 1; name.empty() || (kept_as.empty() && folder.read(file_of(name, ".json"))); ++i)
    name = fmt::format("{}-{}", hash, i);
  Json facts = run.facts;
  facts["load"] = load_json(run.load), facts["held"] = run.held;
  // The signals first: facts without them would be a run that cannot be shown.
  if (kept_as.empty()) write_recording(folder.path_of(file_of(name, ".csv")), run.signals->recording);
  const std::string path = file_of(name, ".json");
  folder.replace(path, folder.read(path), facts.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  return name;
}

void remove_kept_run(const Folder& folder, const std::string& kept_as) {
  std::error_code code;
  fs::remove(folder.path_of(file_of(kept_as, ".json")), code);
  fs::remove(folder.path_of(file_of(kept_as, ".csv")), code);
}

std::vector<std::shared_ptr<StoredRun>> kept_runs(const Folder& folder) {
  std::vector<std::shared_ptr<StoredRun>> runs;
  std::error_code code;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(folder.path() + "/" + std::string(runs_folder), code)) {
    if (entry.path().extension() != ".json") continue;
    const std::string kept_as = entry.path().stem().string();
    try {
      const auto text = folder.read(file_of(kept_as, ".json"));
      auto run = text && folder.is_writable(file_of(kept_as, ".csv")) ? read_run(*text) : nullptr;
      if (!run || !fs::exists(folder.path_of(file_of(kept_as, ".csv")))) continue;
      run->kept_as = kept_as;
      runs.push_back(std::move(run));
    } catch (const Refused&) {  // a name or a link that is not served
    }
  }
  std::ranges::sort(runs, {}, [](const auto& run) {
    return std::pair(run->facts["when"].template get<std::string>(), run->kept_as);
  });
  return runs;
}

std::shared_ptr<const Signals> signals_of_kept_run(const Folder& folder, const std::string& kept_as) {
  Problems problems;
  Recording recording =
      read_recording(folder.path_of(file_of(kept_as, ".csv")), problems, {.allow_not_finite = true});
  if (problems.has_errors()) throw InputError(std::move(problems));
  return std::make_shared<Signals>(std::move(recording));
}

}  // namespace loopwright::studio
