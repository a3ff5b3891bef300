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

bool is_journal(const char* path) noexcept {
  const int file = ::open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return false;
  char begin[journal::magic.size()];
  const bool is_one =
      read_at(file, 0, begin, sizeof begin) && std::string_view(begin, sizeof begin) == journal::magic;
  ::close(file);
  return is_one;
}

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

/// Of a chunk that was read before: its payload is not checked again.
bool JournalReader::read_head(int64_t offset, Chunk& chunk) const {
  journal::ChunkHead head;
  if (!read_at(file_, offset, reinterpret_cast<char*>(&head), sizeof head)) return false;
  chunk = {head.kind, head.rows_before, head.dropped, offset, int64_t(sizeof head + head.size)};
  return head.marker == journal::ChunkHead{}.marker && head.size <= journal::largest_payload;
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

/// Scans the chunks of the whole file and records the locations of rows. Then the gaps between them are
/// known.
void JournalReader::look_through() {
  Chunk chunk;
  std::string payload;
  uint64_t rows_written = 0;
  bool has_heading = false;
  for (int64_t offset = int64_t(journal::magic.size()); offset < size_; offset = chunk.offset + chunk.bytes) {
    if (!read_chunk(offset, chunk, payload)) {
      const int64_t found = find_chunk(offset + 1, chunk, payload);
      (found == size_ ? survey_.tail_bytes : survey_.damaged_bytes) += found - offset;
      if (found == size_) break;
    }
    survey_.dropped_rows = std::max(survey_.dropped_rows, int64_t(chunk.dropped));
    rows_written = std::max(rows_written, chunk.rows_before);  // every chunk has the number of rows before it
    if (chunk.kind == journal::heading && !has_heading) {
      Facts end = std::move(heading_.facts);  // of an end that came before
      heading_ = heading_of(payload, has_heading);
      heading_.facts.insert(heading_.facts.end(), end.begin(), end.end());
    } else if (chunk.kind == journal::end && !survey_.has_end) {
      const Facts facts = Texts(payload).facts();
      heading_.facts.insert(heading_.facts.end(), facts.begin(), facts.end());
      survey_.has_end = true;
    } else if (chunk.kind == journal::rows) {
      note_rows(chunk);
    }
  }
  if (!has_heading)
    refuse(path_, "no heading of the journal is intact: it is not known what its numbers are");
  count_rows(rows_written);
  tell_what_is_lost();
}

/// 0: the chunk does not consist of whole rows, or the columns are not known yet.
uint64_t JournalReader::rows_of(const Chunk& chunk) const {
  const uint64_t bytes = uint64_t(chunk.bytes) - sizeof(journal::ChunkHead);
  const uint64_t row_bytes = heading_.columns.size() * sizeof(double);
  return row_bytes > 0 && bytes % row_bytes == 0 ? bytes / row_bytes : 0;
}

/// Extends the last stretch, or begins another one. Before the first valid heading each chunk is its own.
void JournalReader::note_rows(const Chunk& chunk) {
  const uint64_t rows = rows_of(chunk);
  const bool continues = !stretches_.empty() && rows > 0 &&
                         stretches_.back().offset + stretches_.back().bytes == chunk.offset &&
                         stretches_.back().next_row == chunk.rows_before;
  if (!continues) stretches_.push_back({chunk.rows_before, 0, chunk.offset, 0});
  stretches_.back().next_row = rows > 0 ? chunk.rows_before + rows : 0;
  stretches_.back().bytes += chunk.bytes;
}

/// Sorts the stretches and counts what they give. Chunks whose rows are there already, and chunks that are no
/// whole rows, are left out here and in each_row().
void JournalReader::count_rows(uint64_t rows_written) {
  survey_.is_reordered = !std::ranges::is_sorted(stretches_, {}, &Stretch::first_row);
  std::ranges::stable_sort(stretches_, {}, &Stretch::first_row);
  Chunk chunk;
  uint64_t next_row = 0;
  for (const Stretch& stretch : stretches_)
    for (int64_t offset = stretch.offset; offset < stretch.offset + stretch.bytes; offset += chunk.bytes) {
      if (!read_head(offset, chunk)) refuse(path_, "the journal changed while it was read");
      const uint64_t rows = rows_of(chunk);
      if (rows == 0) {
        survey_.damaged_bytes += chunk.bytes;
      } else if (chunk.rows_before < next_row) {
        survey_.repeated_bytes += chunk.bytes;
      } else {
        survey_.lost_rows += int64_t(chunk.rows_before - next_row);
        survey_.rows += int64_t(rows);
        next_row = chunk.rows_before + rows;
      }
    }
  if (rows_written > next_row) survey_.lost_rows += int64_t(rows_written - next_row);
}

void JournalReader::tell_what_is_lost() {
  auto& facts = heading_.facts;
  const bool is_told =
      std::ranges::any_of(facts, [](const auto& fact) { return fact.first == "incomplete"; });
  if (!survey_.has_end && !is_told)
    facts.emplace_back("incomplete", "the program was ended from outside; recovered from its journal");
  if (!survey_.has_end) facts.emplace_back("rows", fmt::format("{}", survey_.rows));
  if (survey_.lost_rows > 0) facts.emplace_back("lost_rows", fmt::format("{}", survey_.lost_rows));
  if (survey_.dropped_rows > 0) facts.emplace_back("dropped_rows", fmt::format("{}", survey_.dropped_rows));
}

void JournalReader::each_row(const std::function<bool(std::span<const double>)>& take) const {
  const size_t columns = heading_.columns.size();
  std::vector<double> row(columns);
  Chunk chunk;
  std::string payload;
  uint64_t next_row = 0;
  for (const Stretch& stretch : stretches_)
    for (int64_t offset = stretch.offset; offset < stretch.offset + stretch.bytes; offset += chunk.bytes) {
      if (!read_chunk(offset, chunk, payload))
        throw std::runtime_error(fmt::format("\"{}\" changed while it was read", path_));
      const uint64_t rows = rows_of(chunk);
      if (rows == 0 || chunk.rows_before < next_row) continue;
      next_row = chunk.rows_before + rows;
      for (size_t at = 0; at < payload.size(); at += columns * sizeof(double)) {
        std::memcpy(row.data(), payload.data() + at, columns * sizeof(double));
        if (!take(row)) return;
      }
    }
}

}  // namespace loopwright
