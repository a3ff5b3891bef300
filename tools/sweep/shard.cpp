#include "tools/sweep/shard.h"
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include "engine/file/hash.h"
#include "engine/file/regular_file.h"

namespace loopwright {
namespace {

constexpr std::string_view mark = "LwR1";
constexpr size_t head_bytes = 4 + 4 + 8;
constexpr size_t most_bytes = 1 << 20;  // of a record

std::string first_line(const std::string& hash, size_t metrics) {
  return fmt::format("loopwright sweep shard 1 {} {}\n", hash, metrics);
}
uint64_t checksum(std::string_view bytes) { return ContentHash().add(bytes).value(); }

template <class T> void put(std::string& to, const T& value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}
template <class T> T take(const char*& at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  at += sizeof value;
  return value;
}

void put_record(std::string& to, const RunRecord& record) {
  std::string body;
  put(body, record.run), put(body, int64_t(record.failed)), put(body, record.stopped_at);
  for (const double metric : record.metrics) put(body, metric);
  body += record.reason.substr(0, 1000);
  to += mark;
  put(to, uint32_t(body.size())), put(to, checksum(body));
  to += body;
}

/// A window that moves over a file.
class Window {
 public:
  explicit Window(const std::string& path) {
    if (why_not_regular(path).empty()) file_.open(path, std::ios::binary);
  }
  bool is_open() const { return file_.is_open(); }
  /// The next bytes, at least `wanted` if the file has that many.
  std::string_view at_least(size_t wanted) {
    while (bytes_.size() - used_ < wanted && file_) {
      bytes_.erase(0, used_);
      used_ = 0;
      const size_t before = bytes_.size();
      bytes_.resize(before + (1 << 18));
      file_.read(bytes_.data() + before, 1 << 18);
      bytes_.resize(before + size_t(file_.gcount()));
    }
    return std::string_view(bytes_).substr(used_);
  }
  void skip(size_t count) { used_ += count, position_ += int64_t(count); }
  int64_t position() const { return position_; }

 private:
  std::ifstream file_;
  std::string bytes_;
  size_t used_ = 0;
  int64_t position_ = 0;
};

/// Length of the complete record at the start of the bytes; 0: none.
size_t record_length(std::string_view bytes, size_t metrics) {
  if (bytes.size() < head_bytes || !bytes.starts_with(mark)) return 0;
  const char* at = bytes.data() + mark.size();
  const size_t length = take<uint32_t>(at);
  const uint64_t sum = take<uint64_t>(at);
  const size_t least = 24 + 8 * metrics;
  if (length < least || length > most_bytes || bytes.size() < head_bytes + length) return 0;
  return checksum(bytes.substr(head_bytes, length)) == sum ? head_bytes + length : 0;
}

RunRecord parse(std::string_view bytes, size_t metrics) {
  const char* at = bytes.data() + head_bytes;
  RunRecord record;
  record.run = take<int64_t>(at), record.failed = take<int64_t>(at) != 0,
  record.stopped_at = take<double>(at);
  for (size_t m = 0; m < metrics; ++m) record.metrics.push_back(take<double>(at));
  record.reason.assign(at, bytes.data() + bytes.size());
  return record;
}

}  // namespace

namespace {

ShardState read_head(Window& window, const std::string& expected) {
  ShardState state;
  const std::string_view head = window.at_least(expected.size()).substr(0, expected.size());
  if (!window.is_open() || head != expected) {
    const bool is_shard = head.starts_with("loopwright sweep shard");
    state.is_readable = window.is_open() && expected.starts_with(head);  // ended while it was being created
    state.problem = !window.is_open() ? "cannot be read"
                    : is_shard        ? "belongs to another sweep"
                                      : "is no shard of a sweep";
    state.torn_bytes = int64_t(head.size());
    return state;
  }
  state.is_readable = true;
  window.skip(expected.size());
  state.whole_bytes = window.position();
  return state;
}

}  // namespace

ShardState read_head_of_shard(const std::string& path, const std::string& hash, size_t metrics) {
  Window window(path);
  return read_head(window, first_line(hash, metrics));
}

ShardState read_shard(const std::string& path, const std::string& hash, size_t metrics,
                      const std::function<void(const RunRecord&)>& found) {
  Window window(path);
  ShardState state = read_head(window, first_line(hash, metrics));
  if (state.whole_bytes == 0) return state;  // not a shard of this sweep, or one that ended within its header
  for (int64_t skipped = 0;;) {
    std::string_view bytes = window.at_least(head_bytes);
    if (bytes.size() >= head_bytes && bytes.starts_with(mark)) {
      const char* at = bytes.data() + mark.size();
      bytes = window.at_least(head_bytes + std::min<size_t>(take<uint32_t>(at), most_bytes));
    }
    if (const size_t length = record_length(bytes, metrics)) {
      found(parse(bytes.substr(0, length), metrics));
      ++state.records;
      state.damaged_bytes += skipped;
      skipped = 0;
      window.skip(length);
      state.whole_bytes = window.position();
    } else if (bytes.empty()) {
      state.torn_bytes = skipped;
      return state;
    } else {
      const size_t next = bytes.substr(1).find(mark.front());
      const size_t step = next == bytes.npos ? bytes.size() : next + 1;
      skipped += int64_t(step);
      window.skip(step);
    }
  }
}

ShardWriter::ShardWriter(const std::string& path, const std::string& hash, size_t metrics) : path_(path) {
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file_ < 0) fail("cannot be opened", errno);
  if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
    close(file_);
    throw std::runtime_error(path + ": another sweep is writing here");
  }
  const std::string head = first_line(hash, metrics);
  const ShardState state = read_shard(path, hash, metrics, [](const RunRecord&) {});
  if (!state.is_readable) {
    close(file_);
    throw std::runtime_error(path + ": " + state.problem);
  }
  end_ = state.whole_bytes;
  if (ftruncate(file_, end_) != 0) fail("cannot be cut to its whole records", errno);
  if (end_ == 0) write_all(head);
  flush();
}

ShardWriter::~ShardWriter() {
  if (file_ >= 0) close(file_);
}

void ShardWriter::append(std::span<const RunRecord> records) {
  std::string bytes;
  for (const RunRecord& record : records) put_record(bytes, record);
  write_all(bytes);
}

void ShardWriter::write_all(const std::string& bytes) {
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t n = pwrite(file_, bytes.data() + done, bytes.size() - done, end_ + int64_t(done));
    if (n > 0) {
      done += size_t(n);
    } else if (errno != EINTR) {
      const int error = errno;
      [[maybe_unused]] const int cut = ftruncate(file_, end_);  // a part that stays is detected as damaged
      fail("cannot be written", error);
    }
  }
  end_ += int64_t(bytes.size());
}

void ShardWriter::flush() {
  if (fdatasync(file_) != 0) fail("cannot be brought to the disk", errno);
}

void ShardWriter::fail(const char* what, int error) const {
  throw std::runtime_error(fmt::format("{}: {}: {}", path_, what, std::strerror(error)));
}

}  // namespace loopwright
