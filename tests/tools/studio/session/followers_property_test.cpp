/// Renaming in the shipped projects: what loaded before loads after, and undo brings back every byte of every
/// file.
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <set>
#include "tests/tools/studio/session/shipped_diagrams.h"
#include "engine/plan/plan.h"
#include "tools/studio/session/checked_text.h"
#include "tools/studio/session/document.h"
#include "tools/studio/session/followers.h"
#include "tools/sweep/sweep_plan.h"

namespace loopwright::studio::followers_property_test {

namespace {

using Texts = std::map<std::string, std::string>;

class Project {
 public:
  Project() : served_(folder_.path()) {
    paths_ = shipped_diagrams(folder_);
    std::filesystem::remove_all(folder_.path("diagrams/examples"));  // nothing contains them
    std::erase_if(paths_, [](const std::string& path) { return path.starts_with("diagrams/examples/"); });
    for (const std::string& path : paths_) {
      Problems problems;
      const auto diagram = load_diagram(folder_.path(path), {}, problems);
      containing_[path].insert(path);
      if (!diagram) continue;
      for (const std::string& file : diagram->files)
        containing_[served_.relative(std::filesystem::path(file).lexically_normal().string())].insert(path);
    }
  }
  const Folder& served() const { return served_; }
  const std::vector<std::string>& diagrams() const { return paths_; }
  Texts texts() const {
    Texts texts;
    for (const Folder::File& file : served_.files())
      if (file.path.ends_with(".json")) texts[file.path] = folder_.read(file.path);
    return texts;
  }
  /// What loads of all that has to do with a diagram: the diagrams that contain it, alone and with each
  /// experiment of their folder, and their sweeps.
  std::set<std::string> loading(const std::string& changed) const {
    std::set<std::string> loading;
    for (const std::string& path : containing_.at(changed)) {
      Problems problems;
      const auto diagram = load_diagram(folder_.path(path), {}, problems);
      const auto plan = diagram ? compile(*diagram, problems) : nullptr;
      if (!plan || problems.has_errors()) continue;
      loading.insert(path);
      for (const std::string& experiment : experiments_beside(path))
        if (compares(path, experiment)) loading.insert(path + " with " + experiment);
    }
    for (const Folder::File& file : served_.files())
      if (file.path.ends_with(".sweep.json") && sweeps(file.path, containing_.at(changed)))
        loading.insert(file.path);
    return loading;
  }

 private:
  std::vector<std::string> experiments_beside(const std::string& path) const {
    std::vector<std::string> found;
    for (const Folder::File& file : served_.files())
      if (file.path.ends_with(".experiment.json") &&
          std::filesystem::path(file.path).parent_path() == std::filesystem::path(path).parent_path())
        found.push_back(file.path);
    return found;
  }
  /// Whether all ports of the experiment are there. The records themselves are not needed.
  bool compares(const std::string& path, const std::string& experiment) const {
    Problems problems;
    const auto diagram = load_diagram(folder_.path(path), {}, problems);
    const auto plan = compile(*diagram, problems);
    const ParsedText parsed(experiment, folder_.read(experiment));
    for (const Value::Member& compared : parsed.root.find("compare")->value.members)
      if (plan->find(compared.name).empty()) return false;
    return true;
  }
  bool sweeps(const std::string& path, const std::set<std::string>& diagrams) const {
    Problems problems;
    const auto sweep = load_sweep(folder_.path(path), problems);
    if (!sweep || !diagrams.contains(
                      served_.relative(std::filesystem::path(sweep->diagram).lexically_normal().string())))
      return false;
    try {
      const SweepPlan plan(sweep);
      return true;
    } catch (const InputError&) {
      return false;
    }
  }

  StudioFolder folder_;
  const Folder served_;
  std::vector<std::string> paths_;
  std::map<std::string, std::set<std::string>> containing_;  ///< by diagram: those that read its file
};

std::string names_of(const std::string& text, std::string_view list, std::mt19937& random) {
  const ParsedText parsed("", text);
  const Value::Member* entries = parsed.root.find(list);
  if (!entries || entries->value.members.empty()) return "";
  return entries->value.members[random() % entries->value.members.size()].name;
}

}  // namespace

TEST(Renaming, LeavesEverythingLoadableInAllShippedProjects) {
  Project project;
  std::mt19937 random(7);
  const Texts original = project.texts();
  size_t followed = 0, loaded = 0;
  for (const std::string& path : project.diagrams()) {
    const std::set<std::string> loading = project.loading(path);
    loaded += loading.size();
    for (const char* kind : {"block", "parameter"}) {
      const std::string name = names_of(original.at(path), std::string(kind) + "s", random);
      if (name.empty()) continue;
      SCOPED_TRACE(path + ": " + kind + " " + name);
      Document document(project.served(), path);
      std::vector<std::string> left_behind;
      IntentContext context;
      context.followers = [&](const std::vector<studio::Renaming>& renamed) {
        Following following = followers(project.served(), path, document.text(), renamed);
        left_behind = following.left_behind;
        followed += following.files.size();
        return following.files;
      };
      document.edit({json_value(std::string(R"({"intent": "rename_)") + kind + R"(", "name": ")" + name +
                                R"(", "to": "another_name"})")},
                    context, {}, document.revision());
      if (left_behind.empty()) {
        std::set<std::string> missing;
        std::ranges::set_difference(loading, project.loading(path), std::inserter(missing, missing.end()));
        EXPECT_TRUE(missing.empty()) << testing::PrintToString(missing);
      }
      document.undo();
      ASSERT_EQ(project.texts(), original);
    }
  }
  EXPECT_GT(loaded, 100u);
  EXPECT_GT(followed, 20u) << "files that changed with others";
}

}  // namespace loopwright::studio::followers_property_test
