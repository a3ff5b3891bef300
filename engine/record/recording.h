/// Numbers over time, column by column: what a run leaves behind and what a measurement brings.
#pragma once
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

/// All columns have the same length. The first column of a run is "time" in s.
struct Recording {
  std::vector<Column> columns;
  /// Facts that belong to the numbers: title, plan hash, effective parameters ("parameter stage.mass.mass" → "0.2621 kg").
  std::vector<std::pair<std::string, std::string>> facts;

  const Column* find(std::string_view name) const;
  size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
};

}  // namespace loopwright
