#include "tools/experiment/balances.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace loopwright {
namespace {

constexpr double moved = 3;  // resolutions: an encoder at rest varies by one
constexpr size_t fewest = 50;
constexpr double apart_s = 1e-3;  // the sample time of most records, for everything counted in samples

const RecordedSignal* position_of(const Experiment& experiment) {
  for (const auto& [role, port] : experiment.roles.ports)
    if (role == "position")
      for (const RecordedSignal& signal : experiment.compared)
        if (signal.port == port) return &signal;
  return nullptr;
}

/// Rows from `begin` up to `end`.
struct Stand {
  size_t begin, end;
  size_t readings() const { return end - begin; }
};

/// A position with less than half the usual number of rows was only passed through.
void drop_passages(std::vector<Stand>& stands) {
  std::vector<size_t> readings;
  for (const Stand& stand : stands) readings.push_back(stand.readings());
  const auto middle = readings.begin() + std::ptrdiff_t(readings.size() / 2);
  std::ranges::nth_element(readings, middle);
  std::erase_if(stands, [&](const Stand& stand) { return 2 * stand.readings() < *middle; });
}

std::vector<Stand> stands_of(const std::vector<double>& position, double resolution) {
  std::vector<Stand> stands;
  for (size_t k = 0; k < position.size(); ++k) {
    const bool goes_on = !stands.empty() && resolution > 0 &&
                         std::abs(position[k] - position[stands.back().begin]) <= moved * resolution;
    if (!goes_on) stands.push_back({k, k});
    stands.back().end = k + 1;
  }
  if (!stands.empty()) drop_passages(stands);
  return stands;
}

}  // namespace

void reject_map(const Experiment& experiment, Problems& problems) {
  if (!experiment.is_map) return;
  auto& p = problems.error(experiment.map_place, "/rows", "",
                           "a map of balances has no time that a run could follow");
  p.expected = "\"rows\": \"samples\"";
  p.hint = "`loopwright diagnose` reads maps";
}

void gather_balances(Experiment& experiment, Problems& problems) {
  const RecordedSignal* position = position_of(experiment);
  const auto reject = [&](std::string message) -> Problem& {
    return problems.error(experiment.map_place, "/rows", "", std::move(message));
  };
  if (!position) {
    reject("a map of balances needs the position").expected =
        "the role \"position\", and its port among those in \"compare\"";
    return;
  }
  const std::vector<Stand> stands =
      stands_of(experiment.data.find(position->port)->values, position->resolution);
  const size_t count = stands.size();
  if (count < fewest) {
    auto& p = reject(fmt::format("the axis stood at {} places only", count));
    p.expected = fmt::format("at least {}", fewest);
    p.hint = "is the \"resolution\" of the position that of its sensor?";
    return;
  }
  for (Column& column : experiment.data.columns) {
    std::vector<double> means;
    for (const Stand& stand : stands) {
      const auto first = column.values.begin() + std::ptrdiff_t(stand.begin);
      means.push_back(std::accumulate(first, first + std::ptrdiff_t(stand.readings()), 0.0) /
                      double(stand.readings()));
    }
    column.values = std::move(means);
  }
  Column& time = experiment.data.columns.front();
  for (size_t s = 0; s < count; ++s) time.values[s] = double(s) * apart_s;
  experiment.time = {0, apart_s, true, true};
}

}  // namespace loopwright
