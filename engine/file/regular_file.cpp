#include "engine/file/regular_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "engine/file/output_files.h"

namespace loopwright {
namespace {

/// Empty for a regular file.
std::string kind_of(mode_t mode) {
  if (S_ISREG(mode)) return {};
  if (S_ISDIR(mode)) return "it is a folder";
  if (S_ISFIFO(mode)) return "it is a pipe, and only regular files are read";
  if (S_ISSOCK(mode)) return "it is a socket, and only regular files are read";
  return "it is a device, and only regular files are read";
}

/// An open regular file, or the reason why there is none. Opening a named pipe would wait for its writer, and
/// opening a device can act on it. The kind is therefore checked before opening, and again on the opened
/// file.
class OpenFile {
 public:
  explicit OpenFile(const std::string& path) {
    if (path.empty() || path.find('\0') != path.npos) {
      reason_ = "there is no such file";
      return;
    }
    if (::stat(path.c_str(), &status_) != 0) {
      reason_ = errno == ENOENT || errno == ENOTDIR ? "there is no such file" : std::strerror(errno);
      return;
    }
    reason_ = kind_of(status_.st_mode);
    if (!reason_.empty()) return;
    file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (file_ < 0 || ::fstat(file_, &status_) != 0)
      reason_ = std::strerror(errno);
    else
      reason_ = kind_of(status_.st_mode);
    if (reason_.empty()) reason_ = why_reserved(status_);
  }
  ~OpenFile() {
    if (file_ >= 0) ::close(file_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  const std::string& reason() const { return reason_; }
  int descriptor() const { return file_; }
  size_t size() const { return static_cast<size_t>(status_.st_size); }

 private:
  int file_ = -1;
  struct stat status_ {};
  std::string reason_;
};

std::string too_large(size_t largest) {
  constexpr size_t gibibyte = size_t(1) << 30, megabyte = size_t(1) << 20;
  return largest + 1 >= gibibyte ? fmt::format("it is larger than {} GiB", (largest + 1) / gibibyte)
                                 : fmt::format("it is larger than {} MB", largest / megabyte);
}

}  // namespace

std::string why_not_regular(const std::string& path) { return OpenFile(path).reason(); }

std::string read_regular_file(const std::string& path, size_t largest, std::string& bytes) {
  const OpenFile file(path);
  if (!file.reason().empty()) return file.reason();
  if (file.size() > largest) return too_large(largest);
  // Files in /proc report no length, and other files grow: read to the end. With space beyond the reported
  // end, the last read detects it immediately.
  constexpr size_t chunk = 1 << 16;
  size_t length = 0;
  bytes.resize(file.size() + chunk);
  while (true) {
    const ssize_t count = ::read(file.descriptor(), bytes.data() + length, bytes.size() - length);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return std::strerror(errno);
    if (count == 0) break;
    length += static_cast<size_t>(count);
    if (length > largest) return too_large(largest);
    if (bytes.size() - length < chunk) bytes.resize(2 * bytes.size());
  }
  bytes.resize(length);
  return {};
}

}  // namespace loopwright
