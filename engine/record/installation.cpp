#include "engine/record/installation.h"
#include <filesystem>

namespace loopwright {
namespace {

namespace fs = std::filesystem;

fs::path given_prefix;

fs::path prefix() {
  if (!given_prefix.empty()) return given_prefix;
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code);
  return program.parent_path().parent_path();
}

}  // namespace

void set_prefix(std::string prefix) { given_prefix = std::move(prefix); }

std::string library_file(std::string_view name) { return prefix() / "lib" / name; }
std::string shared_file(std::string_view name) { return prefix() / "share/loopwright" / name; }

}  // namespace loopwright
