#include "tools/diagnose/search/jumps.h"
#include <algorithm>
#include <numeric>
#include "models/real/whole.h"
#include "tools/diagnose/search/adjoint.h"
#include "tools/diagnose/search/unknown.h"

namespace loopwright::diagnosis {
namespace {

constexpr size_t most_instants = 3;
/// [rows that count] On either side of a jump: fewer do not tell it from a force that is there all the time.
constexpr double least_side = 0.01;

/// What a jump at each row explains, up to a factor: the square of what the errors have in common with a
/// force that acts from that row on, beside one that acts all the time, by the size of the former.
std::vector<double> explained_by_jumps(const Trial& trial, const Fitted& fitted) {
  const std::vector<double> weight = adjoint(trial, fitted, Acts::force);
  const size_t rows = std::min(weight.size(), trial.held_out_from);
  const double whole = std::reduce(weight.begin(), weight.begin() + std::ptrdiff_t(rows)),
               usable =
                   double(std::count(trial.usable.begin(), trial.usable.begin() + std::ptrdiff_t(rows), 1));
  std::vector<double> explained(rows);
  double after = 0, usable_after = 0;
  for (size_t k = rows; k-- > 0;) {
    after += weight[k], usable_after += trial.usable[k] ? 1 : 0;
    const double share = usable_after / usable, common = after - whole * share;
    if (std::min(share, 1 - share) >= least_side) explained[k] = common * common / (share * (1 - share));
  }
  return explained;
}

/// The rows that explain most, apart from each other.
std::vector<size_t> best_rows(std::vector<double> explained) {
  const size_t apart = whole_count(least_side * double(explained.size())) + 1;
  std::vector<size_t> rows;
  while (rows.size() < most_instants) {
    const auto best = std::ranges::max_element(explained);
    if (best == explained.end() || !(*best > 0)) break;
    const size_t row = size_t(best - explained.begin());
    rows.push_back(row);
    const size_t from = row > apart ? row - apart : 0, to = std::min(explained.size(), row + apart + 1);
    std::fill(explained.begin() + std::ptrdiff_t(from), explained.begin() + std::ptrdiff_t(to), 0.0);
  }
  return rows;
}

}  // namespace

std::vector<Shape> jump_shapes(const Trials& trials, const Estimate& estimate,
                               const std::vector<Candidate>& candidates) {
  std::vector<Shape> shapes;
  if (trials.list.size() != 1) return shapes;
  for (const Candidate& candidate : candidates) {
    if (!candidate.jumps) continue;
    const std::vector<double> time = times_of(*estimate.motion.paths.front());
    std::vector<std::vector<double>> points;
    for (size_t row : best_rows(explained_by_jumps(trials.list.front(), estimate.fitted->front())))
      points.push_back({time[row]});
    if (!points.empty()) add_shapes(candidate, points, estimate.motion, shapes);
  }
  return shapes;
}

}  // namespace loopwright::diagnosis
