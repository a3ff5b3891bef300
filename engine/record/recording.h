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
};

/// All columns have the same length and names of their own. The first column of a run is "time" in s.
struct Recording {
  std::vector<Column> columns;
  /// Facts that belong to the numbers: title, plan hash, effective parameters ("parameter stage.mass.mass" →
  /// "0.2621 kg").
  std::vector<std::pair<std::string, std::string>> facts;

  const Column* find(std::string_view name) const;  ///< nothing when there is no such column
  size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
};

/// Throws std::invalid_argument when columns differ in length, have no name or share one: a recording made by
/// a program must be right before it is written.
void check_recording(const Recording& recording);

/// How strictly a recording is read. Every default refuses what would mislead later.
struct ReadOptions {
  bool allow_not_finite = false;    ///< a NaN is a hole in a measurement: it spoils every sum it enters
  int most_problems = 20;           ///< one screenful shows what is wrong; the rest is counted
  size_t longest_line = 1 << 20;    ///< [bytes] CSV: some 50,000 columns; beyond that it is no table
  bool leave_out_misfits = false;   ///< MAT: a variable that fits no column is an error, not lost unseen
  int time_limit = 60;              ///< [s] MAT: damaged files can send the MAT library into an endless loop
  size_t memory_limit = 8ul << 30;  ///< [bytes] MAT: a damaged size can ask for more than there is
};

}  // namespace loopwright
