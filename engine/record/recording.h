/// Numbers over time, column by column: the result of a run or of a measurement.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/json/problem.h"

namespace loopwright {

/// The cells of a column that hold no number; their values are NaN.
struct Holes {
  size_t count = 0;            ///< of what is to be told: cells of a CSV file
  std::vector<Problem> first;  ///< what is wrong with the first of them, each at its place in the file
};

struct Column {
  std::string name;  ///< "stage.position", "motor.force[2]"
  std::string unit;  ///< SI unit; empty: not known
  std::vector<double> values;
  std::string origin;  ///< file:line:column of its heading, or its file; empty: not from a file
  Holes holes{};       ///< only with ReadOptions::allow_holes; whoever uses the column refuses them
};

/// All columns have the same length and distinct names. The first column of a run is "time" in s.
struct Recording {
  std::vector<Column> columns;
  /// Facts about the numbers: title, plan hash, effective parameters ("parameter stage.mass.mass" → "0.2621
  /// kg").
  std::vector<std::pair<std::string, std::string>> facts;
  /// The order of the columns is the original order, so that the first may be the time. Variables of a MAT
  /// file are unordered.
  bool is_ordered = true;

  const Column* find(std::string_view name) const;  ///< null if there is no such column
  size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
};

/// Throws std::invalid_argument if columns differ in length, have no name or share a name: a recording
/// created by a program must be valid before it is written.
void check_recording(const Recording& recording);

/// How strictly a recording is read. Every default rejects data that could mislead later.
struct ReadOptions {
  bool allow_not_finite = false;  ///< a NaN is a gap in a measurement and spoils every sum
  /// A cell without a number is no error of the file but one of the Holes of its column, so that a column of
  /// remarks does no harm to the others. Every user must refuse the columns that it uses: find_column().
  bool allow_holes = false;
  int most_problems = 20;          ///< enough for one screen; the rest is counted
  size_t longest_line = 1 << 20;   ///< [bytes] CSV: about 50,000 columns; longer is not a table
  bool leave_out_misfits = false;  ///< MAT: otherwise a variable that fits no column is an error
  /// MAT: one flipped bit can make matio compute for minutes and use gigabytes for a file of a kilobyte.
  int time_limit = 10;              ///< [s of computing] and 1 s more per 4 MB of file
  size_t memory_limit = 2ul << 30;  ///< [bytes] and 64 more per byte of file, as it may be compressed
  bool operator==(const ReadOptions&) const = default;
};

}  // namespace loopwright
