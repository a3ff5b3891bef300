#include "tools/experiment/impossible_values.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace loopwright {
namespace {

/// [SI] The largest number in single precision is 3.4e38, by which some programs mark a missing one.
constexpr double largest = 1e30;

}  // namespace

void reject_impossible_values(const Experiment& experiment, Problems& problems) {
  for (const auto* list : {&experiment.drives, &experiment.compared})
    for (const RecordedSignal& signal : *list) {
      const Column* column = experiment.data.find(signal.port);
      if (!column) continue;
      const auto is_impossible = [](double value) { return std::abs(value) > largest; };
      const auto first = std::ranges::find_if(column->values, is_impossible);
      if (first == column->values.end()) continue;
      const auto row = size_t(first - column->values.begin());
      auto& p = problems.error(signal.place, signal.pointer, "",
                               fmt::format("column \"{}\": no sensor gives {:.3g}", signal.column, *first));
      p.found = fmt::format("{} such values, the first at {:.6g} s",
                            std::ranges::count_if(column->values, is_impossible),
                            experiment.data.columns.front().values[row]);
      p.hint = "leave out the rows without a reading";
    }
}

}  // namespace loopwright
