#include "tools/experiment/repeated_records.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace loopwright {
namespace {

/// Also where neither has a reading.
bool are_same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::ranges::equal(a, b,
                            [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

/// The same values of some compared signal, at the same times.
bool have_same_rows(const Experiment& a, const Experiment& b) {
  if (a.data.columns.empty() || b.data.columns.empty()) return false;
  if (a.data.columns[0].values != b.data.columns[0].values) return false;
  for (const RecordedSignal& signal : a.compared)
    for (const RecordedSignal& other : b.compared) {
      const Column *x = a.data.find(signal.port), *y = b.data.find(other.port);
      if (x && y && are_same(x->values, y->values)) return true;
    }
  return false;
}

}  // namespace

void refuse_repeated_records(const std::vector<std::shared_ptr<const Experiment>>& experiments,
                             Problems& problems) {
  for (size_t i = 1; i < experiments.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      if (!experiments[i] || !experiments[j] || !have_same_rows(*experiments[j], *experiments[i])) continue;
      Problem& problem =
          problems.error(experiments[i]->place, "/data", "",
                         fmt::format("this record is used already, by {}", experiments[j]->path));
      problem.expected =
          "another record: one that counts twice, or is both fitted and held out, proves nothing";
      problem.found = experiments[i]->data_path;
      break;
    }
}

}  // namespace loopwright
