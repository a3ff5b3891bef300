#include "tools/diagnose/record/dead_sensor.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {

void reject_if_constant(const RecordedSignal& compared, const loopwright::Column& column,
                        Problems& problems) {
  const std::vector<double>& values = column.values;
  const auto first = std::ranges::find_if(values, [](double v) { return std::isfinite(v); });
  if (std::any_of(first, values.end(), [&](double v) { return std::isfinite(v) && v != *first; })) return;
  auto& p = problems.error(compared.place, compared.pointer, "",
                           fmt::format("the measured \"{}\" never changes", compared.column));
  p.expected = "a signal that shows how the diagram answers its inputs";
}

size_t leaps_by_a_turn(std::span<const double> angle) {
  size_t count = 0;
  for (size_t k = 1; k < angle.size(); ++k) {
    const double turns = std::abs(angle[k] - angle[k - 1]) / (2 * std::numbers::pi);
    if (turns < criteria::most_way_within_row || std::isnan(turns)) continue;
    if (std::abs(turns - 1) > criteria::most_way_within_row) return 0;
    ++count;
  }
  return count;
}

bool is_noise_alone(std::span<const double> values) {
  double mean = 0, squares = 0, changes = 0;
  for (const double v : values) mean += v / double(values.size());
  for (size_t k = 0; k < values.size(); ++k) {
    squares += (values[k] - mean) * (values[k] - mean);
    if (k > 0) changes += (values[k] - values[k - 1]) * (values[k] - values[k - 1]);
  }
  return double(values.size()) >= criteria::least_rows && changes > criteria::changes_of_noise * squares;
}

}  // namespace loopwright::diagnosis
