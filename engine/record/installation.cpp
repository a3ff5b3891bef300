#include "engine/record/installation.h"
#include <filesystem>

namespace loopwright {
namespace {

namespace fs = std::filesystem;

fs::path prefix() {
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code);
  return program.parent_path().parent_path();
}

}  // namespace

std::string library_file(std::string_view name) { return prefix() / "lib" / name; }
std::string shared_file(std::string_view name) { return prefix() / "share/loopwright" / name; }

}  // namespace loopwright
