#include "engine/record/recording.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>
#include <unordered_set>

namespace loopwright {

const Column* Recording::find(std::string_view name) const {
  const auto found = std::ranges::find(columns, name, &Column::name);
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
