#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <set>
#include "engine/diagram/diagram.h"
#include "engine/diagram/drive.h"
#include "engine/diagram/in_memory.h"
#include "engine/diagram/diagram_load.h"

namespace loopwright {

constexpr size_t deepest_nesting = 32;  // nesting of subdiagrams

std::shared_ptr<Diagram> DiagramLoad::load(const std::string& path, const Place& reference,
                                           Instance instance) {
  const auto fail = [&](std::string message) -> Problem& {
    return problems.error(reference, reference.pointer(), instance.block, std::move(message));
  };
  if (opened.size() == deepest_nesting) {
    fail(fmt::format("subdiagrams nest deeper than {} levels", deepest_nesting));
    return nullptr;
  }
  const std::string identity = library.identity(path);
  if (const auto first = std::ranges::find(identities, identity); first != identities.end()) {
    std::string chain;
    for (auto i = static_cast<size_t>(first - identities.begin()); i < opened.size(); ++i)
      chain += opened[i] + " → ";
    fail("a diagram contains itself").found = chain + path;
    return nullptr;
  }
  const DiagramFile& file = library.open(path, reference);
  if (file.root.kind != Value::Kind::object) return nullptr;
  opened.push_back(path);
  identities.push_back(identity);
  auto diagram = read(file.root, file.blocks(), path, std::move(instance));
  opened.pop_back();
  identities.pop_back();
  return diagram;
}

namespace {

/// A diagram that is used many times reports the same problem only once.
void add_without_repetition(const Problems& found, Problems& problems) {
  std::set<std::tuple<const SourceFile*, uint32_t, std::string_view>> told;
  for (const Problem& problem : found.list())
    if (told.insert({problem.place.file.get(), problem.place.offset, problem.message}).second)
      problems.add(problem);
}

/// The options that apply to the outermost diagram.
Instance top_instance(const LoadOptions& options, Problems& problems) {
  Instance top;
  for (const auto& option : options.set)
    if (auto edit = read_edit(option, problems)) top.edits.push_back(std::move(*edit));
  for (const Value::Member& setting : options.set_in_file)
    if (auto edit = read_edit(setting, problems)) top.edits.push_back(std::move(*edit));
  for (const auto& [block, variant] : options.variants)
    if (auto choice = read_variant_choice(block, variant, problems))
      top.variants.push_back(std::move(*choice));
  return top;
}

/// Reads the outermost diagram by `read` and applies the options.
template <class Read>
std::shared_ptr<const Diagram> with_options(const LoadOptions& options, Problems& problems, Read&& read) {
  Problems found;
  Instance top = top_instance(options, found);
  DiagramLoad load{found};
  const std::shared_ptr<Diagram> diagram = read(load, std::move(top));
  if (diagram) {
    apply_drives(*diagram, options.drives, found);
    diagram->files = load.library.take_names();
    diagram->files_read = found.files();
    std::erase_if(diagram->files_read, [&](const FileRead& file) { return file.path == diagram->path; });
  }
  add_without_repetition(found, problems);
  return diagram;
}

}  // namespace

std::shared_ptr<const Diagram> load_diagram(const std::string& path, const LoadOptions& options,
                                            Problems& problems) {
  return with_options(options, problems,
                      [&](DiagramLoad& load, Instance top) { return load.load(path, {}, std::move(top)); });
}

std::shared_ptr<const Diagram> load_diagram_text(const std::shared_ptr<const SourceFile>& file,
                                                 const LoadOptions& options, Problems& problems) {
  return with_options(options, problems, [&](DiagramLoad& load, Instance top) {
    load.library.hold(file);
    return load.load(file->name, {}, std::move(top));
  });
}

std::shared_ptr<const Diagram> read_diagram(const Value& root, const std::string& path,
                                            const LoadOptions& options, Problems& problems) {
  return with_options(options, problems, [&](DiagramLoad& load, Instance top) {
    return load.read(root, BlockList(root.find("blocks")), path, std::move(top));
  });
}

std::string resolve_relative(const Place& place, std::string_view path) {
  const std::filesystem::path relative(path);
  if (!place.file || relative.is_absolute()) return std::string(path);
  return (std::filesystem::path(place.file->name).parent_path() / relative).lexically_normal().string();
}

}  // namespace loopwright
