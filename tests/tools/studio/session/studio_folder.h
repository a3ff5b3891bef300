/// A folder with files for a test; removed afterwards.
#pragma once
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <unistd.h>
#include "tools/studio/session/draft.h"

namespace loopwright::studio {

class StudioFolder {
 public:
  StudioFolder() {
    // Thousands of edits are written to the disk at once, each; in memory that takes no time.
    const std::filesystem::path memory = "/dev/shm";
    const bool has_memory = ::access(memory.c_str(), W_OK) == 0;
    std::string name =
        ((has_memory ? memory : std::filesystem::temp_directory_path()) / "loopwright_studio_XXXXXX")
            .string();
    path_ = ::mkdtemp(name.data());
  }
  ~StudioFolder() {
    std::error_code code;
    std::filesystem::remove_all(path_, code);
  }
  StudioFolder(const StudioFolder&) = delete;
  StudioFolder& operator=(const StudioFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string path(const std::string& name) const { return path_ + "/" + name; }
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
    std::ofstream(path(name), std::ios::binary) << text;
  }
  std::string read(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(path(name), std::ios::binary).rdbuf();
    return text.str();
  }

 private:
  std::string path_;
};

/// A JSON value, as requests contain them.
inline Value json_value(const std::string& text) { return ParsedText("test", text).root; }

}  // namespace loopwright::studio
