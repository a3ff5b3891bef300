#include "engine/block/registry.h"
#include <dlfcn.h>
#include <fmt/format.h>
#include <algorithm>
#include <deque>
#include <limits>
#include <set>
#include <stdexcept>
#include "engine/file/hash.h"
#include "engine/file/regular_file.h"

namespace loopwright {
namespace {

std::map<std::string, BlockType, std::less<>>& registry() {
  static std::map<std::string, BlockType, std::less<>> types;
  return types;
}

/// The result of loading a library: its initializers must not throw.
struct Loading {
  const FileRead* library;
  std::vector<std::string> added, refused;
};
Loading* loading = nullptr;

std::string origin_of(const BlockType& type) {
  return type.library ? "of the library " + type.library->path : "built in, " + type.info.source;
}

Problem& cannot_load(const std::string& path, Problems& problems) {
  return problems.error({}, "", "", fmt::format("the block library \"{}\" cannot be loaded", path));
}

}  // namespace

const std::map<std::string, BlockType, std::less<>>& all_blocks() { return registry(); }

const BlockType* find_block(std::string_view type) {
  const auto found = registry().find(type);
  return found == registry().end() ? nullptr : &found->second;
}

bool is_factor(std::string_view type, std::string_view parameter) {
  const BlockType* block = find_block(type);
  return block && std::ranges::any_of(block->info.parameters, [&](const ParameterInfo& info) {
           return info.name == parameter && info.plain_when_bare;
         });
}

void add_block(std::span<const size_t> layout, BlockInfo&& info, const Kernels<double>& kernels) {
  if (!std::ranges::equal(layout, block_layout)) {  // no part of the block can be read
    if (!loading) throw std::logic_error("a block was compiled against other headers");
    loading->refused.emplace_back();
    return;
  }
  const std::string name = info.type;
  const auto [entry, is_new] =
      registry().try_emplace(name, BlockType{std::move(info), kernels, loading ? loading->library : nullptr});
  if (!loading && !is_new) throw std::logic_error("two blocks are called " + name);
  if (loading) (is_new ? loading->added : loading->refused).push_back(name);
}

void load_block_library(const std::string& path, Problems& problems) {
  static std::set<void*> loaded;
  // A bare file name would be searched only in the system folders.
  const std::string file = path.find('/') == path.npos ? "./" + path : path;
  static std::deque<FileRead> libraries;  // block types point to them
  std::string bytes;
  const std::string reason = read_regular_file(file, std::numeric_limits<uint32_t>::max(), bytes);
  if (!reason.empty()) {
    cannot_load(path, problems).found = reason;
    return;
  }
  Loading now{&libraries.emplace_back(FileRead{path, content_hash(bytes)}), {}, {}};
  loading = &now;
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
  loading = nullptr;
  if (!library) {
    const char* cause = dlerror();
    cannot_load(path, problems).found = cause ? cause : "";
    return;
  }
  if (!loaded.insert(library).second) return;  // named twice
  if (now.added.empty() && now.refused.empty())
    cannot_load(path, problems).found = "it has no block, LOOPWRIGHT_BLOCK(…)";
  for (const std::string& name : now.refused) {
    if (name.empty()) {
      auto& p = cannot_load(path, problems);
      p.found = "it was compiled against the headers of another version";
      p.hint = "compile it again, -I naming the headers of this program";
      break;
    }
    auto& p = problems.error({}, "", "", fmt::format("two blocks are called \"{}\"", name));
    const BlockType* first = find_block(name);
    p.found = fmt::format("one {}, and one of the library {}", first ? origin_of(*first) : "", path);
    p.hint = "give the block of the library another name";
  }
  if (now.refused.empty()) return;
  for (const std::string& name : now.added) registry().erase(name);
}

}  // namespace loopwright
