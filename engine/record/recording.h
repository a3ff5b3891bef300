/// Numbers over time, column by column: what a run leaves behind and what a measurement brings.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace loopwright {

struct Column {
  std::string name;  ///< "stage.position", "motor.force[2]"
  std::string unit;  ///< SI unit; empty: not known
  std::vector<double> values;
  std::string origin;  ///< file:line:column of its heading, or its file; empty: it comes from no file
};

/// All columns have the same length and names of their own. The first column of a run is "time" in s.
struct Recording {
  std::vector<Column> columns;
  /// Facts that belong to the numbers: title, plan hash, effective parameters ("parameter stage.mass.mass" →
  /// "0.2621 kg").
  std::vector<std::pair<std::string, std::string>> facts;
  /// The order of the columns is that of their maker: the first may be the time. Variables of a MAT file have
  /// none.
  bool is_ordered = true;

  const Column* find(std::string_view name) const;  ///< nothing when there is no such column
  size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
};

/// Throws std::invalid_argument when columns differ in length, have no name or share one: a recording made by
/// a program must be right before it is written.
void check_recording(const Recording& recording);

/// How strictly a recording is read. Every default refuses what would mislead later.
struct ReadOptions {
  bool allow_not_finite = false;   ///< a NaN is a hole in a measurement: it spoils every sum it enters
  int most_problems = 20;          ///< one screenful shows what is wrong; the rest is counted
  size_t longest_line = 1 << 20;   ///< [bytes] CSV: some 50,000 columns; beyond that it is no table
  bool leave_out_misfits = false;  ///< MAT: a variable that fits no column is an error, not lost unseen
  /// MAT: one flipped bit can make matio compute for minutes and take gigabytes for a file of a kilobyte.
  int time_limit = 10;              ///< [s of computing] and 1 s more per 4 MB of file
  size_t memory_limit = 2ul << 30;  ///< [bytes] and 64 more per byte of file, which may be compressed
};

}  // namespace loopwright
