/// A recording that is stored on disk while it grows: rows are only appended, and every part has a checksum.
///
///     file    magic, 8 bytes "LWJRNL1\n"; then chunks
///     chunk   offset  0  u32   marker 0x4b4e4843 ("CHNK")
///                     4  u32   kind: 1 heading, 2 rows, 3 end
///                     8  u64   bytes of the payload
///                    16  u64   rows written before this chunk
///                    24  u64   rows left out so far, because the disk was too slow
///                    32  u32   CRC-32C of the 32 bytes before and of the payload
///                    36  u32   0
///                    40  payload
///     heading         u64 columns, then name and unit of each; u64 facts, then key and value of each. A text
///                     is its length in bytes as u64 and its UTF-8 bytes. The heading is repeated at
///                     intervals in case one is damaged.
///     rows            one f64 for each column, row by row
///     end             u64 facts, then key and value of each: facts known only at the end. It is the last
///                     chunk; without it the writer was interrupted.
///
/// All numbers are little-endian. From a file that is truncated or damaged at any position, every chunk with
/// a valid checksum can be read.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/record/recording.h"

namespace loopwright {

using Facts = std::vector<std::pair<std::string, std::string>>;

/// Appends to a journal. Errors are errno values; after an error the file ends with the last complete chunk.
class JournalWriter {
 public:
  /// Creates the file and synchronizes its heading to disk. `heading` has columns without values. Throws
  /// std::runtime_error if the file cannot be created or already exists: a journal that was not recovered is
  /// the only copy of its rows.
  JournalWriter(std::string path, const Recording& heading);
  ~JournalWriter();
  JournalWriter(const JournalWriter&) = delete;
  JournalWriter& operator=(const JournalWriter&) = delete;

  const std::string& path() const { return path_; }
  /// Appends complete rows, row by row. `dropped`: rows left out so far.
  int append(std::span<const double> rows, int64_t dropped);
  int repeat_heading();
  int end(const Facts& facts, int64_t dropped);
  /// Synchronizes the appended data to disk; may be called by another thread during append().
  int sync() noexcept;
  int64_t rows() const { return rows_; }

 private:
  int put(uint32_t kind, std::string_view payload, int64_t dropped);

  std::string path_, heading_;
  size_t columns_;
  int file_ = -1;
  int64_t rows_ = 0, size_ = 0;
};

/// The contents of a journal, and its losses.
struct JournalSurvey {
  int64_t rows = 0;            ///< with valid checksums
  int64_t lost_rows = 0;       ///< between valid rows, known from their numbers
  int64_t dropped_rows = 0;    ///< never written, as the disk was too slow
  int64_t damaged_bytes = 0;   ///< that belong to no valid chunk and are followed by complete chunks
  int64_t repeated_bytes = 0;  ///< of valid chunks whose rows another chunk has given already
  int64_t tail_bytes = 0;      ///< that belong to no complete chunk, at the end of the file
  bool has_end = false;        ///< the writer finished
  bool is_reordered = false;   ///< the chunks of the file are in another order than their rows
  bool is_whole() const { return lost_rows == 0 && damaged_bytes == 0 && tail_bytes == 0; }
};

/// Whether a file of that path begins as a journal does. Allocates nothing.
bool is_journal(const char* path) noexcept;

/// Reads a journal with constant memory. Errors of the file give an InputError: it cannot be read, is not a
/// journal, or has no valid heading.
class JournalReader {
 public:
  explicit JournalReader(std::string path);
  ~JournalReader();
  JournalReader(const JournalReader&) = delete;
  JournalReader& operator=(const JournalReader&) = delete;

  const std::string& path() const { return path_; }
  const JournalSurvey& survey() const { return survey_; }
  /// Columns without values, and all facts; for a truncated or damaged journal also "incomplete".
  const Recording& heading() const { return heading_; }
  /// take(row) for every valid row, in the order in which they were written, until it returns false.
  void each_row(const std::function<bool(std::span<const double>)>& take) const;

 private:
  struct Chunk {
    uint32_t kind = 0;
    uint64_t rows_before = 0, dropped = 0;
    int64_t offset = 0, bytes = 0;  // of the complete chunk in the file
  };
  /// Complete chunks of consecutive rows that follow one another in the file.
  struct Stretch {
    uint64_t first_row = 0, next_row = 0;
    int64_t offset = 0, bytes = 0;
  };
  void look_through();
  bool read_head(int64_t offset, Chunk& chunk) const;
  bool read_chunk(int64_t offset, Chunk& chunk, std::string& payload) const;
  int64_t find_chunk(int64_t from, Chunk& chunk, std::string& payload) const;
  uint64_t rows_of(const Chunk& chunk) const;
  void note_rows(const Chunk& chunk);
  void count_rows(uint64_t rows_written);
  void tell_what_is_lost();

  std::string path_;
  int file_ = -1;
  int64_t size_ = 0;
  std::vector<Stretch> stretches_;  // sorted by their first row
  Recording heading_;
  JournalSurvey survey_;
};

/// Writes the rows of a journal as .csv or .mat, according to the extension; see write_recording(). CSV needs
/// constant memory; MAT needs about 20 bytes per number, as its columns are written one after the other.
/// False: `stops` returned true meanwhile, and the target is unchanged.
bool write_journal_as(
    const std::string& path, const JournalReader& journal,
    const std::function<bool()>& stops = [] { return false; });

/// Reads the journal into memory. If there are more than `most_rows` rows, each group of rows is replaced by
/// two: one with the smallest, one with the largest values, both at the time of the first, so that a plot
/// shows every peak.
Recording read_journal(const JournalReader& journal, size_t most_rows);

}  // namespace loopwright
