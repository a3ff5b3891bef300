/// Recordings as comma-separated values: files of this program, exact to the last bit, and files of other
/// instruments.
#pragma once
#include <cstdio>
#include <memory>
#include <span>
#include <string>

#include "engine/json/problem.h"
#include "engine/record/atomic_file.h"
#include "engine/record/recording.h"

namespace loopwright {

/// Reads a table of numbers.
///
///     # loopwright recording: 1
///     # plan: 85944171f73967e8
///     time [s],stage.position [m]
///     0,0.00010782208
///
/// The separator is a comma, semicolon, tab or blanks, whichever is consistent for header and first row.
/// Names may be quoted; without a header they are c1, c2, …. A unit follows its name in square brackets
/// ("force[2]" is an index, not a unit). Lines that begin with # become facts, under the name "comment" if
/// they have no "key: value". A comment directly above unnamed columns becomes the header if it has as many
/// names. CRLF and a byte order mark are accepted, and decimal commas if another character separates the
/// cells and at least one comma cannot separate thousands. In a file with the first line above, names and
/// facts are unescaped (see text.h); otherwise they are literal.
///
/// Errors, with line and column: a file that cannot be read, is not UTF-8 text, has no rows or has a line
/// that is too long; empty or repeated names; rows whose length differs from the header, a truncated last
/// row; empty cells, text, decimal commas beside decimal points, numbers beyond the range of a double, NaN
/// and infinity. After any of them the recording is empty. With ReadOptions::allow_holes, cells without a
/// number are holes of their columns instead, and a last column without name and contents is left out. A
/// first line "sep=;" states the separator.
Recording read_csv(const std::string& path, Problems& problems, const ReadOptions& options = {});

/// The same for text in memory.
Recording parse_csv(std::shared_ptr<const SourceFile> source, Problems& problems,
                    const ReadOptions& options = {});

/// Writes so that read_csv() restores every name, unit, fact and double (a NaN as some NaN). A recording with
/// facts, or with names that need escapes, begins with the line "# loopwright recording: 1". The file appears
/// completely or not at all. Throws std::runtime_error if it cannot be written (see atomic_file.h),
/// std::invalid_argument if the recording is not valid (see check_recording).
void write_csv(const std::string& path, const Recording& recording);

/// Writes the same file row by row, for recordings larger than memory. Without commit() the target is
/// unchanged.
class CsvWriter {
 public:
  /// `heading`: columns and facts; its values are not written.
  CsvWriter(const std::string& path, const Recording& heading);
  /// One number for each column.
  void add(std::span<const double> row);
  void commit();

 private:
  AtomicFile file_;
  std::string text_;  // not yet written
};

/// Writes the same text to an open stream, such as standard output. Throws std::runtime_error if writing
/// fails.
void print_csv(std::FILE* stream, const Recording& recording);

}  // namespace loopwright
