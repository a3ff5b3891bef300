#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cerrno>
#include <filesystem>
#include <set>
#include "engine/json/problem.h"
#include "engine/record/atomic_file.h"
#include "engine/record/installation.h"
#include "tools/command/command.h"
#include "tools/schema/schema.h"

namespace loopwright {
namespace {

namespace fs = std::filesystem;

struct NewProjectArguments {
  std::string folder, kind = "linear_motor";
};

std::set<std::string> kinds() {
  std::set<std::string> names;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(shared_file("diagrams/projects"), code))
    if (entry.is_directory()) names.insert(entry.path().filename());
  return names;
}

[[noreturn]] void refuse(std::string message, std::string expected, std::string hint = "") {
  Problems problems;
  auto& problem = problems.error({}, "", "", std::move(message));
  problem.expected = std::move(expected), problem.hint = std::move(hint);
  throw InputError(std::move(problems));
}

/// A new folder beside another, which is removed with its contents unless it gets that one's name.
class PartOf {
 public:
  explicit PartOf(const fs::path& folder)
      : folder_(folder), path_(fmt::format("{}.part-{}", folder.string(), ::getpid())) {
    if (::mkdir(path_.c_str(), 0777) != 0)  // what is there already is not ours
      throw fs::filesystem_error("", std::error_code(errno, std::generic_category()));
  }
  ~PartOf() {
    std::error_code ignored;
    if (!is_complete_) fs::remove_all(path_, ignored);
  }
  PartOf(const PartOf&) = delete;
  PartOf& operator=(const PartOf&) = delete;

  const fs::path& path() const { return path_; }
  void complete() {
    fs::rename(path_, folder_);
    is_complete_ = true;
  }

 private:
  const fs::path folder_, path_;
  bool is_complete_ = false;
};

/// The shipped project, and the schemas of its files for editors. The folder appears as a whole or not at
/// all.
int create(const NewProjectArguments& a) {
  const auto known = kinds();
  if (!known.contains(a.kind)) {
    const std::string near = nearest_name(a.kind, {known.begin(), known.end()});
    refuse(fmt::format("there is no project \"{}\" to begin with", a.kind),
           fmt::format("one of {}", fmt::join(known, ", ")),
           near.empty() ? "" : fmt::format("did you mean \"{}\"?", near));
  }
  fs::path folder = fs::path(a.folder).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();  // "name/"
  if (fs::symlink_status(folder).type() != fs::file_type::not_found)
    refuse(fmt::format("\"{}\" exists already", a.folder), "the name of a new folder");
  try {
    PartOf part(folder);
    fs::copy(shared_file("diagrams/projects/" + a.kind), part.path(), fs::copy_options::recursive);
    write_schemas((part.path() / "schemas").string());
    fs::create_directory(part.path() / ".vscode");
    write_file((part.path() / ".vscode/settings.json").string(), editor_settings("schemas"));
    part.complete();
  } catch (const fs::filesystem_error& error) {
    refuse(fmt::format("\"{}\" cannot be created: {}", a.folder, error.code().message()),
           "a folder that can be written");
  }
  answer(
      "{0}: a project with a model, an experiment and a README\n  cd {0} && loopwright run nominal.json "
      "--report run.html\n",
      folder.string());
  return done;
}

}  // namespace

void add_new(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("new", "Begin a project: a model, an experiment and a README");
  auto a = std::make_shared<NewProjectArguments>();
  command->add_option("folder", a->folder, "Folder to create")->required();
  command->add_option("--from", a->kind, "linear_motor, servo, pendulum or thermal")->capture_default_str();
  command->callback([=] { choose([=] { return create(*a); }); });
}

}  // namespace loopwright
