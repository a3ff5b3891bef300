#include "engine/record/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <utility>

namespace loopwright {
namespace {

constexpr size_t largest = std::numeric_limits<uint32_t>::max();

/// Reads until the end and says why it could not; empty when all went well.
std::string read_all(int file, std::string& bytes) {
  struct stat status;
  if (::fstat(file, &status) != 0) return std::strerror(errno);
  if (S_ISDIR(status.st_mode)) return "it is a folder";
  if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode)) return "it is neither a file nor a pipe";
  constexpr size_t chunk = 1 << 16;
  const size_t announced = S_ISREG(status.st_mode) ? static_cast<size_t>(status.st_size) : 0;
  if (announced > largest) return "it is larger than 4 GiB";
  size_t length = 0;
  bytes.resize(announced + chunk);  // room beyond the announced end: the last read then finds the end at once
  while (true) {
    const ssize_t count = ::read(file, bytes.data() + length, bytes.size() - length);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return std::strerror(errno);
    if (count == 0) break;
    length += static_cast<size_t>(count);
    if (length > largest) return "it is larger than 4 GiB";
    if (bytes.size() - length < chunk) bytes.resize(2 * bytes.size());
  }
  bytes.resize(length);
  return {};
}

}  // namespace

std::shared_ptr<const SourceFile> read_input_file(const std::string& path, Problems& problems) {
  auto source = std::make_shared<SourceFile>();
  source->name = path;
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const std::string reason = file < 0 ? std::strerror(errno) : read_all(file, source->text);
  if (file >= 0) ::close(file);
  if (!reason.empty()) {
    source->text.clear();
    problems.error({source, 0}, {}, {}, "the file cannot be read: " + reason);
  }
  return source;
}

}  // namespace loopwright
