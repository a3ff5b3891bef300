#include "engine/plan/identity.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "engine/file/hash.h"
#include "engine/file/regular_file.h"
#include "engine/record/text.h"

namespace loopwright {
namespace {

constexpr std::string_view file_fact = "file ";

int take_build_id(dl_phdr_info* object, size_t, void* to);

/// Whether this function is part of a loaded object: of the program itself, or of a module in another program.
bool is_this_object(const dl_phdr_info& object) {
  const auto here = reinterpret_cast<ElfW(Addr)>(&take_build_id);
  for (int i = 0; i < object.dlpi_phnum; ++i) {
    const ElfW(Phdr)& part = object.dlpi_phdr[i];
    const ElfW(Addr) begin = object.dlpi_addr + part.p_vaddr;
    if (part.p_type == PT_LOAD && here >= begin && here < begin + part.p_memsz) return true;
  }
  return false;
}

/// Copies the build identifier from the notes of the object that contains this function.
int take_build_id(dl_phdr_info* object, size_t, void* to) {
  if (!is_this_object(*object)) return 0;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& part = object->dlpi_phdr[i];
    if (part.p_type != PT_NOTE) continue;
    const char* at = reinterpret_cast<const char*>(object->dlpi_addr + part.p_vaddr);
    const char* const end = at + part.p_memsz;
    const auto padded = [](size_t length) { return (length + 3) & ~size_t(3); };
    while (at + sizeof(ElfW(Nhdr)) <= end) {
      const auto* note = reinterpret_cast<const ElfW(Nhdr)*>(at);
      const char* const name = at + sizeof *note;
      const char* const bytes = name + padded(note->n_namesz);
      if (note->n_type == NT_GNU_BUILD_ID &&
          std::string_view(name, note->n_namesz) == std::string_view("GNU", 4)) {
        static_cast<std::string*>(to)->assign(bytes, note->n_descsz);
        return 1;
      }
      at = bytes + padded(note->n_descsz);
    }
  }
  return 1;  // the other objects are not of interest
}

std::string find_build() {
  std::string identifier;
  dl_iterate_phdr(take_build_id, &identifier);
  // If the linker writes no identifier, use the bytes of the program.
  if (identifier.empty())
    read_regular_file("/proc/self/exe", std::numeric_limits<uint32_t>::max(), identifier);
  return content_hash(identifier);
}

/// The contents of each name: files of the same name may be read from several folders.
std::map<std::string, std::set<std::string>> by_name(const Identity& identity) {
  std::map<std::string, std::set<std::string>> contents;
  for (const FileRead& file : identity.files) contents[file.path].insert(file.hash);
  return contents;
}

}  // namespace

std::string Identity::hash() const {
  ContentHash all;
  all.add(structure).add("\n").add(build).add("\n");
  for (const FileRead& file : files) all.add(escape(file.path, ":")).add(": ").add(file.hash).add("\n");
  return all.text();
}

Facts Identity::facts() const {
  Facts list = {{"plan", hash()}, {"plan structure", structure}, {"build", build}};
  for (const FileRead& file : files) list.emplace_back(std::string(file_fact) + file.path, file.hash);
  return list;
}

Identity identity_of(const Facts& facts) {
  Identity identity;
  for (const auto& [name, value] : facts)
    if (name == "plan structure")
      identity.structure = value;
    else if (name == "build")
      identity.build = value;
    else if (name.starts_with(file_fact))
      identity.files.push_back({name.substr(file_fact.size()), value});
  return identity;
}

std::string to_text(const Facts& facts) {
  std::string text;
  for (const auto& [name, value] : facts) text += fmt::format("{}: {}\n", escape(name, ":"), escape(value));
  return text;
}

Facts facts_of(std::string_view text) {
  Facts facts;
  for (size_t end; (end = text.find('\n')) != text.npos; text.remove_prefix(end + 1)) {
    const std::string_view line = text.substr(0, end);
    const size_t colon = line.find(": ");
    if (colon == line.npos) break;
    facts.emplace_back(unescape(line.substr(0, colon)), unescape(line.substr(colon + 2)));
  }
  return facts;
}

std::vector<std::string> changes(const Identity& before, const Identity& now) {
  std::vector<std::string> list;
  const auto old_contents = by_name(before), new_contents = by_name(now);
  for (const auto& [name, contents] : old_contents)
    if (const auto found = new_contents.find(name); found == new_contents.end()) {
      list.push_back(fmt::format("the file \"{}\" is not read any more", name));
    } else if (found->second != contents) {
      list.push_back(fmt::format("the file \"{}\" has changed", name));
    }
  for (const auto& [name, contents] : new_contents)
    if (!old_contents.contains(name))
      list.push_back(fmt::format("the file \"{}\" is read in addition", name));
  if (before.structure != now.structure)
    list.push_back("the diagram or its parameters (--set, --variant) have changed");
  return list;
}

std::string changes_with_build(const Identity& before, const Identity& now) {
  std::vector<std::string> list = changes(before, now);
  if (before.build != now.build)
    list.push_back(fmt::format("the program is another build ({}, here {})",
                               before.build.empty() ? "an older one" : before.build, now.build));
  return fmt::format("{}", fmt::join(list, "; "));
}

std::vector<FileRead> named_from(const std::string& diagram, std::vector<FileRead> files) {
  const auto folder = std::filesystem::path(diagram).parent_path();
  for (FileRead& file : files) {
    std::filesystem::path path = file.path, from = folder.empty() ? "." : folder;
    if (path.is_absolute() != from.is_absolute()) path = absolute(path), from = absolute(from);
    file.path = path.lexically_normal().lexically_proximate(from.lexically_normal()).string();
  }
  const auto both = [](const FileRead& file) { return std::tie(file.path, file.hash); };
  std::ranges::sort(files, {}, both);
  const auto same = [&](const FileRead& a, const FileRead& b) { return both(a) == both(b); };
  files.erase(std::unique(files.begin(), files.end(), same), files.end());
  return files;
}

const std::string& program_build() {
  static const std::string build = find_build();
  return build;
}

}  // namespace loopwright
