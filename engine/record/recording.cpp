#include "engine/record/recording.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>
#include <unordered_set>

#include "engine/record/csv_syntax.h"

namespace loopwright {

const Column* Recording::find(std::string_view name) const {
  auto found = std::ranges::find(columns, name, &Column::name);
  if (found != columns.end()) return &*found;
  // The heading as it stands in the file, "Time (ms)", finds the column "Time" in ms.
  const csv::Heading heading = csv::read_heading(name);
  if (heading.unit.empty()) return nullptr;
  found = std::ranges::find_if(
      columns, [&](const Column& column) { return column.name == heading.name && column.unit == heading.unit; });
  return found == columns.end() ? nullptr : &*found;
}

void check_recording(const Recording& recording) {
  std::unordered_set<std::string_view> names;
  for (const Column& column : recording.columns) {
    if (column.name.empty()) throw std::invalid_argument("a column of the recording has no name");
    if (!names.insert(column.name).second)
      throw std::invalid_argument(fmt::format("two columns of the recording are named \"{}\"", column.name));
    if (column.values.size() != recording.rows())
      throw std::invalid_argument(fmt::format("column \"{}\" of the recording has {} rows, the first has {}",
                                              column.name, column.values.size(), recording.rows()));
  }
}

}  // namespace loopwright
