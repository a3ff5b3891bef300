#include "engine/record/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

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

/// In the folder of the target, so that the rename stays on one file system; hidden, so that glob patterns
/// over results do not match it.
std::string temporary_prefix(const std::string& target) {
  return fmt::format(".{}.", target.substr(target.rfind('/') + 1, 200));  // npos + 1 = 0
}
std::string temporary_name(const std::string& target) {
  static std::atomic<unsigned> counter{0};
  return fmt::format("{}{}{}-{}", target.substr(0, target.rfind('/') + 1), temporary_prefix(target),
                     ::getpid(), counter++);
}

/// The process in the "1234-5" at the end of a temporary name; 0: the text has another form.
pid_t process_of(std::string_view ending) {
  pid_t process = 0;
  unsigned number = 0;
  const char* const end = ending.data() + ending.size();
  const auto first = std::from_chars(ending.data(), end, process);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != '-' || process <= 0) return 0;
  const auto second = std::from_chars(first.ptr + 1, end, number);
  return second.ec == std::errc() && second.ptr == end ? process : 0;
}

/// The hidden files of a folder when this program first wrote into it: a folder of many results is listed
/// only once.
std::vector<std::string> hidden_files(const std::string& folder) {
  static std::mutex mutex;
  static std::map<std::string, std::vector<std::string>> of_folder;
  const std::lock_guard lock(mutex);
  const auto [entry, is_new] = of_folder.try_emplace(folder);
  std::error_code code;
  if (is_new)
    for (std::filesystem::directory_iterator i(folder, code), end; !code && i != end; i.increment(code))
      if (std::string name = i->path().filename().string(); name.starts_with('.'))
        entry->second.push_back(std::move(name));
  return entry->second;
}

/// Removes partial files that terminated programs left beside the target. A temporary file is locked while
/// its program writes it, on any machine, and its name has the process of the program: both must be gone.
void remove_left_behind(const std::string& target) {
  const std::string folder = folder_of(target), prefix = temporary_prefix(target);
  for (const std::string& name : hidden_files(folder)) {
    if (!name.starts_with(prefix)) continue;
    const pid_t process = process_of(std::string_view(name).substr(prefix.size()));
    if (process == 0 || ::kill(process, 0) == 0 || errno != ESRCH) continue;
    const std::string path = folder + '/' + name;
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0) continue;
    struct stat status;
    if (::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && ::flock(file, LOCK_EX | LOCK_NB) == 0)
      ::unlink(path.c_str());
    ::close(file);
  }
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
  // A pipe, or a file without a name (deleted standard output), cannot be replaced.
  if (existing && (!S_ISREG(existing->st_mode) || existing->st_nlink == 0)) {
    file_ = ::open(path_.c_str(), flags);
    if (file_ < 0) fail(errno);
    return;
  }
  // A file that its owner has write-protected must not be replaced.
  if (existing && ::access(target_.c_str(), W_OK) != 0) fail(errno);
  remove_left_behind(target_);
  do {
    temporary_ = temporary_name(target_);
    file_ = ::open(temporary_.c_str(), flags | O_CREAT | O_EXCL, 0666);
  } while (file_ < 0 && errno == EEXIST);
  if (file_ >= 0) (void)::flock(file_, LOCK_EX | LOCK_NB);  // best effort: see remove_left_behind()
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
  // The rename reaches the disk with its folder. If the folder cannot be synchronized, no data is lost yet.
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
