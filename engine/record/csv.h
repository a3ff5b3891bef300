/// Recordings as comma-separated values: ours, exact to the last bit, and those of other people's
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
/// The separator is a comma, semicolon, tab or blanks, whichever header and first row agree on. Names may be
/// quoted; without a header they are c1, c2, …; a unit follows its name in square brackets ("force[2]" is an
/// index, no unit). Lines that begin with # become facts, under the name "comment" where they have no "key:
/// value"; a comment just above unnamed columns that names as many becomes the header. CRLF and a byte order
/// mark are taken in stride. In a file with the first line above, names and facts are unescaped (see text.h),
/// otherwise they are literal.
///
/// Errors, with line and column: a file that cannot be read, is not UTF-8 text, has no rows or a line that is
/// too long; empty or repeated names; rows of another length than the header, a last row that is cut off;
/// empty cells, text, decimal commas, numbers beyond a double, NaN and infinity. After any of them the
/// recording is empty.
Recording read_csv(const std::string& path, Problems& problems, const ReadOptions& options = {});

/// The same for text that is in memory already.
Recording parse_csv(std::shared_ptr<const SourceFile> source, Problems& problems,
                    const ReadOptions& options = {});

/// Writes so that read_csv() restores every name, unit, fact and double (of a NaN: that it is one). A
/// recording with facts, or with names that need escapes, begins with the line "# loopwright recording: 1".
/// The file appears whole or not at all. Throws std::runtime_error when it cannot be written (see
/// atomic_file.h), std::invalid_argument when the recording is not well formed (see check_recording).
void write_csv(const std::string& path, const Recording& recording);

/// The same file row by row, for recordings that are longer than memory. Without commit() the target stays as
/// it was.
class CsvWriter {
 public:
  /// `heading`: columns and facts; its values are not written.
  CsvWriter(const std::string& path, const Recording& heading);
  /// A number for each column.
  void add(std::span<const double> row);
  void commit();

 private:
  AtomicFile file_;
  std::string text_;  // not yet handed over
};

/// The same text to an open stream, such as standard output. Throws std::runtime_error when it takes no more.
void print_csv(std::FILE* stream, const Recording& recording);

}  // namespace loopwright
