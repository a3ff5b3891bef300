#include "engine/block/registry.h"
#include <dlfcn.h>
#include <stdexcept>

namespace loopwright {

static std::map<std::string, BlockType, std::less<>>& registry() {
  static std::map<std::string, BlockType, std::less<>> types;
  return types;
}

const std::map<std::string, BlockType, std::less<>>& all_blocks() { return registry(); }

const BlockType* find_block(std::string_view type) {
  const auto found = registry().find(type);
  return found == registry().end() ? nullptr : &found->second;
}

void add_block(BlockInfo info, const Kernels<double>& kernels) {
  std::string name = info.type;
  if (!registry().emplace(name, BlockType{std::move(info), kernels}).second)
    throw std::logic_error("two blocks are called " + name);
}

void load_block_library(const std::string& path) {
  // A bare file name would be searched for in the system's folders only.
  const std::string file = path.find('/') == path.npos ? "./" + path : path;
  if (!dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL))
    throw std::runtime_error("cannot load the block library " + path + ": " + dlerror());
}

}  // namespace loopwright
