#include "engine/record/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>
#include <utility>

namespace loopwright {
namespace {

/// The path that a chain of symbolic links leads to; the path itself when it does not exist yet.
std::string follow_links(const std::string& path) {
  char* resolved = ::realpath(path.c_str(), nullptr);
  if (!resolved) return path;
  std::string target = resolved;
  std::free(resolved);
  return target;
}

std::string folder_of(const std::string& path) {
  const size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

/// Beside the target, so that the rename stays on one file system; hidden, so that globs over results miss
/// it.
std::string temporary_name(const std::string& target) {
  static std::atomic<unsigned> counter{0};
  const size_t name = target.rfind('/') + 1;  // npos + 1 = 0
  return fmt::format("{}.{}.{}-{}", target.substr(0, name), target.substr(name, 200), ::getpid(), counter++);
}

std::optional<struct stat> status_of(const std::string& path) {
  struct stat status;
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return status;
}

}  // namespace

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)), target_(follow_links(path_)) {
  constexpr int flags = O_WRONLY | O_CLOEXEC;
  const std::optional<struct stat> existing = status_of(target_);
  if (existing && S_ISDIR(existing->st_mode)) fail(EISDIR);
  // Neither a pipe nor a file without a name (standard output that was deleted meanwhile) can be replaced.
  if (existing && (!S_ISREG(existing->st_mode) || existing->st_nlink == 0)) {
    file_ = ::open(path_.c_str(), flags);
    if (file_ < 0) fail(errno);
    return;
  }
  // A file that its owner protected against writing must not be replaced behind his back.
  if (existing && ::access(target_.c_str(), W_OK) != 0) fail(errno);
  do {
    temporary_ = temporary_name(target_);
    file_ = ::open(temporary_.c_str(), flags | O_CREAT | O_EXCL, 0666);
  } while (file_ < 0 && errno == EEXIST);
  if (file_ < 0) {
    const int reason = errno;
    temporary_.clear();
    fail(reason);
  }
  if (existing) (void)::fchmod(file_, existing->st_mode & 07777);  // best effort: not on every file system
}

AtomicFile::~AtomicFile() {
  if (file_ >= 0) ::close(file_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    bytes.remove_prefix(static_cast<size_t>(written));
  }
}

void AtomicFile::commit() {
  const bool replaces = !temporary_.empty();
  if (replaces && ::fsync(file_) != 0) fail(errno);
  const int file = std::exchange(file_, -1);
  if (::close(file) != 0) fail(errno);
  if (!replaces) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  temporary_.clear();
  // The rename itself reaches the disk with its folder; where a folder cannot be synchronised, nothing is
  // lost yet.
  const int folder = ::open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    (void)::fsync(folder);
    ::close(folder);
  }
}

void AtomicFile::fail(int error_number) const {
  std::string reason = std::strerror(error_number);
  if (error_number == ENOENT) reason = fmt::format("the folder \"{}\" does not exist", folder_of(target_));
  if (error_number == EISDIR) reason = "it is a folder";
  throw std::runtime_error(fmt::format("cannot write \"{}\": {}", path_, reason));
}

void write_file(const std::string& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace loopwright
