#include <fcntl.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <stdexcept>

#include "engine/record/journal.h"
#include "engine/record/journal_layout.h"

namespace loopwright {
namespace {

void append_little_endian(std::string& to, uint64_t number) {
  to.append(reinterpret_cast<const char*>(&number), sizeof number);
}
void append_text(std::string& to, std::string_view text) {
  append_little_endian(to, text.size());
  to += text;
}
void append_facts(std::string& to, const Facts& facts) {
  append_little_endian(to, facts.size());
  for (const auto& [key, value] : facts) append_text(to, key), append_text(to, value);
}

/// The name reaches the disk with its folder; not every file system supports this.
void sync_folder_of(const std::string& path) {
  const size_t slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  (void)::fsync(file);
  ::close(file);
}

}  // namespace

JournalWriter::JournalWriter(std::string path, const Recording& heading)
    : path_(std::move(path)), columns_(heading.columns.size()) {
  check_recording(heading);
  append_little_endian(heading_, columns_);
  for (const Column& column : heading.columns)
    append_text(heading_, column.name), append_text(heading_, column.unit);
  append_facts(heading_, heading.facts);
  file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file_ < 0 && errno == EEXIST)
    throw std::runtime_error(fmt::format(
        "\"{0}\" exists already: the log of a run that did not come to its end, or is still going on.\n"
        "  hint: loopwright recover \"{0}\" -o FILE.csv makes a log of it; remove it when it is not "
        "wanted",
        path_));
  if (file_ < 0)
    throw std::runtime_error(fmt::format("cannot write \"{}\": {}", path_, std::strerror(errno)));
  int error = ::write(file_, journal::magic.data(), journal::magic.size()) == ssize_t(journal::magic.size())
                  ? 0
                  : (errno ? errno : ENOSPC);
  size_ = int64_t(journal::magic.size());
  if (error == 0) error = repeat_heading();
  if (error == 0) error = sync();
  if (error != 0) {
    ::close(file_);
    ::unlink(path_.c_str());
    throw std::runtime_error(fmt::format("cannot write \"{}\": {}", path_, std::strerror(error)));
  }
  sync_folder_of(path_);
}

JournalWriter::~JournalWriter() { ::close(file_); }

int JournalWriter::append(std::span<const double> rows, int64_t dropped) {
  const std::string_view payload(reinterpret_cast<const char*>(rows.data()), rows.size_bytes());
  const int error = put(journal::rows, payload, dropped);
  if (error == 0) rows_ += int64_t(rows.size() / columns_);
  return error;
}

int JournalWriter::repeat_heading() { return put(journal::heading, heading_, 0); }

int JournalWriter::end(const Facts& facts, int64_t dropped) {
  std::string payload;
  append_facts(payload, facts);
  const int error = put(journal::end, payload, dropped);
  return error ? error : sync();
}

int JournalWriter::sync() noexcept { return ::fdatasync(file_) == 0 ? 0 : errno; }

int JournalWriter::put(uint32_t kind, std::string_view payload, int64_t dropped) {
  journal::ChunkHead head;
  head.kind = kind, head.size = payload.size(), head.rows_before = uint64_t(rows_);
  head.dropped = uint64_t(dropped);
  head.checksum = journal::checksum_of(head, payload);
  iovec parts[] = {{&head, sizeof head}, {const_cast<char*>(payload.data()), payload.size()}};
  for (size_t i = 0; i < 2;) {
    const ssize_t written = ::writev(file_, parts + i, int(2 - i));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int error = errno;
      (void)!::ftruncate(file_, size_);  // readers would only skip half a chunk
      return error;
    }
    for (size_t rest = size_t(written); i < 2; ++i) {
      const size_t taken = std::min(rest, parts[i].iov_len);
      parts[i].iov_base = static_cast<char*>(parts[i].iov_base) + taken;
      parts[i].iov_len -= taken, rest -= taken;
      if (parts[i].iov_len > 0) break;
    }
  }
  size_ += int64_t(sizeof head + payload.size());
  return 0;
}

}  // namespace loopwright
