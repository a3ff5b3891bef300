#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>

#include "engine/json/problem.h"
#include "engine/record/journal.h"
#include "engine/record/journal_layout.h"

namespace loopwright {
namespace {

[[noreturn]] void refuse(const std::string& path, std::string message, std::string hint = "") {
  Problems problems;
  problems.error({}, "", "", fmt::format("{}: {}", path, message)).hint = std::move(hint);
  throw InputError(std::move(problems));
}

/// Reads exactly this number of bytes; false: the file has fewer.
bool read_at(int file, int64_t offset, char* to, size_t bytes) {
  while (bytes > 0) {
    const ssize_t got = ::pread(file, to, bytes, offset);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    to += got, offset += got, bytes -= size_t(got);
  }
  return true;
}

/// Consecutive numbers and texts; never reads beyond the end.
class Texts {
 public:
  explicit Texts(std::string_view bytes) : rest_(bytes) {}
  uint64_t number() {
    uint64_t number = 0;
    if (rest_.size() < sizeof number) return is_good_ = false, 0;
    std::memcpy(&number, rest_.data(), sizeof number);
    rest_.remove_prefix(sizeof number);
    return number;
  }
  std::string text() {
    const uint64_t size = number();
    if (size > rest_.size()) return is_good_ = false, "";
    std::string text(rest_.substr(0, size));
    rest_.remove_prefix(size);
    return text;
  }
  Facts facts() {
    Facts facts;
    for (uint64_t left = number(); left > 0 && is_good_; --left) {
      std::string key = text();
      facts.emplace_back(std::move(key), text());
    }
    return facts;
  }
  bool is_good() const { return is_good_; }

 private:
  std::string_view rest_;
  bool is_good_ = true;
};

Recording heading_of(std::string_view payload, bool& is_good) {
  Texts texts(payload);
  Recording heading;
  for (uint64_t left = texts.number(); left > 0 && texts.is_good(); --left) {
    std::string name = texts.text();
    heading.columns.push_back({std::move(name), texts.text(), {}});
  }
  heading.facts = texts.facts();
  is_good = texts.is_good() && !heading.columns.empty();
  return heading;
}

}  // namespace

JournalReader::JournalReader(std::string path) : path_(std::move(path)) {
  file_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file_ < 0) refuse(path_, fmt::format("the journal cannot be read: {}", std::strerror(errno)));
  try {
    struct stat status;
    if (::fstat(file_, &status) != 0 || !S_ISREG(status.st_mode)) refuse(path_, "it is no file");
    size_ = status.st_size;
    std::string begin(journal::magic.size(), 0);
    if (!read_at(file_, 0, begin.data(), begin.size()) || begin != journal::magic)
      refuse(path_, "this is no journal of a deployment",
             "deploy -o LOG.csv keeps one as LOG.csv.journal while it runs");
    look_through();
  } catch (...) {
    ::close(file_);
    throw;
  }
}

JournalReader::~JournalReader() { ::close(file_); }

bool JournalReader::read_chunk(int64_t offset, Chunk& chunk, std::string& payload) const {
  journal::ChunkHead head;
  if (!read_at(file_, offset, reinterpret_cast<char*>(&head), sizeof head)) return false;
  if (head.marker != journal::ChunkHead{}.marker || head.unused != 0 || head.size > journal::largest_payload)
    return false;
  payload.resize(head.size);
  if (!read_at(file_, offset + int64_t(sizeof head), payload.data(), payload.size())) return false;
  if (journal::checksum_of(head, payload) != head.checksum) return false;
  chunk = {head.kind, head.rows_before, head.dropped, offset, int64_t(sizeof head + head.size)};
  return true;
}

/// The offset of the first valid chunk from there on; the size of the file if there is none.
int64_t JournalReader::find_chunk(int64_t from, Chunk& chunk, std::string& payload) const {
  constexpr size_t window = 1 << 20;
  constexpr uint32_t marker = journal::ChunkHead{}.marker;
  const std::string_view wanted(reinterpret_cast<const char*>(&marker), sizeof marker);
  std::string bytes;
  for (int64_t offset = from; offset < size_; offset += window - int64_t(wanted.size()) + 1) {
    bytes.resize(size_t(std::min<int64_t>(window, size_ - offset)));
    if (!read_at(file_, offset, bytes.data(), bytes.size())) break;
    for (size_t at = bytes.find(wanted); at != bytes.npos; at = bytes.find(wanted, at + 1))
      if (read_chunk(offset + int64_t(at), chunk, payload)) return offset + int64_t(at);
  }
  return size_;
}

/// Scans the chunks of the whole file and records the locations of rows and the gaps between them.
void JournalReader::look_through() {
  Chunk chunk;
  std::string payload;
  uint64_t next_row = 0;
  bool has_heading = false;
  for (int64_t offset = int64_t(journal::magic.size()); offset < size_; offset = chunk.offset + chunk.bytes) {
    if (!read_chunk(offset, chunk, payload)) {
      const int64_t found = find_chunk(offset + 1, chunk, payload);
      (found == size_ ? survey_.tail_bytes : survey_.damaged_bytes) += found - offset;
      if (found == size_) break;
    }
    survey_.dropped_rows = std::max(survey_.dropped_rows, int64_t(chunk.dropped));
    // Every chunk has the number of rows before it. Rows before the first valid heading are lost too.
    if (chunk.rows_before > next_row) {
      survey_.lost_rows += int64_t(chunk.rows_before - next_row);
      next_row = chunk.rows_before;
    }
    if (chunk.kind == journal::heading && !has_heading) {
      heading_ = heading_of(payload, has_heading);
    } else if (chunk.kind == journal::end) {
      const Facts facts = Texts(payload).facts();
      heading_.facts.insert(heading_.facts.end(), facts.begin(), facts.end());
      survey_.has_end = true;
    } else if (chunk.kind == journal::rows) {
      const size_t row_bytes = heading_.columns.size() * sizeof(double);
      if (has_heading && payload.size() % row_bytes == 0 && chunk.rows_before == next_row)
        next_row += note_rows(chunk, payload.size() / row_bytes);
      else
        survey_.damaged_bytes += chunk.bytes;
    }
  }
  if (!has_heading)
    refuse(path_, "no heading of the journal is intact: it is not known what its numbers are");
  tell_what_is_lost();
}

uint64_t JournalReader::note_rows(const Chunk& chunk, uint64_t rows) {
  survey_.rows += int64_t(rows);
  if (row_chunks_.empty() || row_chunks_.back().first + row_chunks_.back().second != chunk.offset)
    row_chunks_.emplace_back(chunk.offset, 0);
  row_chunks_.back().second += chunk.bytes;
  return rows;
}

void JournalReader::tell_what_is_lost() {
  auto& facts = heading_.facts;
  const bool is_told =
      std::ranges::any_of(facts, [](const auto& fact) { return fact.first == "incomplete"; });
  if (!survey_.has_end && !is_told)
    facts.emplace_back("incomplete", "the program was ended from outside; recovered from its journal");
  if (survey_.lost_rows > 0) facts.emplace_back("lost_rows", fmt::format("{}", survey_.lost_rows));
  if (survey_.dropped_rows > 0) facts.emplace_back("dropped_rows", fmt::format("{}", survey_.dropped_rows));
}

void JournalReader::each_row(const std::function<bool(std::span<const double>)>& take) const {
  const size_t columns = heading_.columns.size();
  std::vector<double> row(columns);
  Chunk chunk;
  std::string payload;
  for (const auto& [begin, bytes] : row_chunks_)
    for (int64_t offset = begin; offset < begin + bytes; offset += chunk.bytes) {
      if (!read_chunk(offset, chunk, payload))
        throw std::runtime_error(fmt::format("\"{}\" changed while it was read", path_));
      for (size_t at = 0; at < payload.size(); at += columns * sizeof(double)) {
        std::memcpy(row.data(), payload.data() + at, columns * sizeof(double));
        if (!take(row)) return;
      }
    }
}

}  // namespace loopwright
