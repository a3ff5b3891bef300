/// A diagram file that lives as long as a benchmark.
#pragma once
#include <fmt/format.h>
#include <unistd.h>
#include <filesystem>
#include <string>
#include <string_view>
#include "engine/record/atomic_file.h"

namespace loopwright::benchmarks {

class DiagramFile {
 public:
  explicit DiagramFile(std::string_view text) {
    static int files = 0;
    path_ = std::filesystem::temp_directory_path() /
            fmt::format("loopwright_benchmark_{}_{}.json", getpid(), files++);
    write_file(path_, text);
  }
  ~DiagramFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  DiagramFile(const DiagramFile&) = delete;
  DiagramFile& operator=(const DiagramFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace loopwright::benchmarks
