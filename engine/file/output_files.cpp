#include "engine/file/output_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

namespace loopwright {
namespace {

struct Reserved {
  dev_t device;
  ino_t number;
  std::string path, option;
};

std::vector<Reserved>& reserved() {
  static std::vector<Reserved> files;
  return files;
}

}  // namespace

bool is_same_file(const std::string& a, const std::string& b) {
  struct stat first, second;
  const bool has_first = ::stat(a.c_str(), &first) == 0, has_second = ::stat(b.c_str(), &second) == 0;
  if (has_first && has_second) return first.st_dev == second.st_dev && first.st_ino == second.st_ino;
  if (has_first || has_second) return false;
  const auto whole = [](const std::string& path) {
    std::error_code code;
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, code), code);
  };
  return whole(a) == whole(b);
}

void reserve_for_output(const std::string& path, const std::string& option) {
  struct stat file;
  if (::stat(path.c_str(), &file) == 0 && S_ISREG(file.st_mode))
    reserved().push_back({file.st_dev, file.st_ino, path, option});
}

std::string why_reserved(const struct stat& file) {
  for (const Reserved& output : reserved())
    if (output.device == file.st_dev && output.number == file.st_ino)
      return fmt::format("{} {} names the same file, and would replace it", output.option, output.path);
  return {};
}

}  // namespace loopwright
