/// A recording that is on disk while it grows: rows are only ever appended, and every part has a checksum.
///
///     file    magic, 8 bytes "LWJRNL1\n"; then chunks
///     chunk   offset  0  u32   marker 0x4b4e4843 ("CHNK")
///                     4  u32   kind: 1 heading, 2 rows, 3 end
///                     8  u64   bytes of the payload
///                    16  u64   rows written before this chunk
///                    24  u64   rows left out so far, because the disk did not take them in time
///                    32  u32   CRC-32C of the 32 bytes before and of the payload
///                    36  u32   0
///                    40  payload
///     heading         u64 columns, then name and unit of each; u64 facts, then key and value of each. A text
///     is
///                     its length in bytes as u64 and its UTF-8 bytes. Repeated now and then, should one be
///                     hurt.
///     rows            one f64 a column, row by row
///     end             u64 facts, then key and value of each: what is only known at the end. The last chunk;
///     its
///                     absence tells that the writer was cut off.
///
/// All numbers are little-endian. A file that was cut off anywhere, or damaged, yields every chunk that
/// checks out.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/record/recording.h"

namespace loopwright {

using Facts = std::vector<std::pair<std::string, std::string>>;

/// Appends to a journal. Errors are errno; after one, the file ends with the last whole chunk.
class JournalWriter {
 public:
  /// Makes the file and brings its heading to the disk. `heading` has columns without values. Throws
  /// std::runtime_error when it cannot be made, and when there is one already: a journal that was not
  /// recovered is the only copy of its rows.
  JournalWriter(std::string path, const Recording& heading);
  ~JournalWriter();
  JournalWriter(const JournalWriter&) = delete;
  JournalWriter& operator=(const JournalWriter&) = delete;

  const std::string& path() const { return path_; }
  /// Whole rows, row by row. `dropped`: rows left out so far.
  int append(std::span<const double> rows, int64_t dropped);
  int repeat_heading();
  int end(const Facts& facts, int64_t dropped);
  /// Brings what was appended to the disk; may be called beside append() by another thread.
  int sync() noexcept;
  int64_t rows() const { return rows_; }

 private:
  int put(uint32_t kind, std::string_view payload, int64_t dropped);

  std::string path_, heading_;
  size_t columns_;
  int file_ = -1;
  int64_t rows_ = 0, size_ = 0;
};

/// What a journal holds, and what of it is lost.
struct JournalSurvey {
  int64_t rows = 0;           ///< that check out
  int64_t lost_rows = 0;      ///< between rows that check out, told by their numbers
  int64_t dropped_rows = 0;   ///< were never written: the disk did not take them in time
  int64_t damaged_bytes = 0;  ///< that belong to no chunk that checks out, with whole chunks behind them
  int64_t tail_bytes = 0;     ///< that belong to no whole chunk, at the end of the file
  bool has_end = false;       ///< the writer came to its end
  bool is_whole() const { return lost_rows == 0 && damaged_bytes == 0 && tail_bytes == 0; }
};

/// Reads a journal in memory of constant size. Errors of the file are an InputError: it cannot be read, is no
/// journal, or no heading of it checks out.
class JournalReader {
 public:
  explicit JournalReader(std::string path);
  ~JournalReader();
  JournalReader(const JournalReader&) = delete;
  JournalReader& operator=(const JournalReader&) = delete;

  const std::string& path() const { return path_; }
  const JournalSurvey& survey() const { return survey_; }
  /// Columns without values, and all facts; of a journal that was cut off or damaged also "incomplete".
  const Recording& heading() const { return heading_; }
  /// take(row) for every row that checks out, in order; ends when it answers false.
  void each_row(const std::function<bool(std::span<const double>)>& take) const;

 private:
  struct Chunk {
    uint32_t kind = 0;
    uint64_t rows_before = 0, dropped = 0;
    int64_t offset = 0, bytes = 0;  // of the whole chunk in the file
  };
  void look_through();
  bool read_chunk(int64_t offset, Chunk& chunk, std::string& payload) const;
  int64_t find_chunk(int64_t from, Chunk& chunk, std::string& payload) const;
  uint64_t note_rows(const Chunk& chunk, uint64_t rows);
  void tell_what_is_lost();

  std::string path_;
  int file_ = -1;
  int64_t size_ = 0;
  std::vector<std::pair<int64_t, int64_t>> row_chunks_;  // offset and bytes of runs of whole chunks
  Recording heading_;
  JournalSurvey survey_;
};

/// Writes the rows of a journal as .csv or .mat, by the end of the path; see write_recording(). CSV takes
/// constant memory; MAT takes some 20 bytes a number, as its columns are written one after the other. False:
/// `stops` answered true on the way, and the target is as it was.
bool write_journal_as(
    const std::string& path, const JournalReader& journal,
    const std::function<bool()>& stops = [] { return false; });

/// The journal in memory. Of more than `most_rows` rows a row holds the least, the next one the greatest
/// values of so many rows, each at the time of the first, so that a picture of them shows every peak.
Recording read_journal(const JournalReader& journal, size_t most_rows);

}  // namespace loopwright
