#include "tools/diagnose/predict/even_path.h"
#include <algorithm>
#include <cmath>
#include "models/real/whole.h"
#include "tools/experiment/even_grid.h"

namespace loopwright::diagnosis {
EvenPath::EvenPath(const Path& path, int parts) : edges_(edges_of(path.duration)) {
  const size_t rows = std::max<size_t>(1, whole_count(std::ceil(edges_.back() * parts)));
  for (size_t i = 0; i <= rows; ++i) even_edges_.push_back(double(i) / parts);
  for (size_t i = 0, row = 0; i < rows; ++i) {
    const auto distance = [&](size_t k) { return std::abs(even_edges_[i] - edges_[k]); };
    while (row + 1 < path.samples() && distance(row + 1) < distance(row)) ++row;
    const double later = (even_edges_[i] - edges_[row]) * path.sample_time;
    const double v = path.velocity[row], a = path.acceleration[row];
    position_.push_back(path.position[row] + (v + 0.5 * a * later) * later);
    velocity_.push_back(v + a * later);
  }
  const auto even = [&](const std::vector<double>& held) {
    return over_other_intervals({held, {}}, edges_, even_edges_).mean;
  };
  acceleration_ = even(path.acceleration);
  if (!path.input.empty()) input_ = even(path.input);
  if (!path.force.empty()) force_ = even(path.force);
}

RoleSignals EvenPath::signals() const {
  RoleSignals signals;
  signals.position = position_, signals.velocity = velocity_, signals.acceleration = acceleration_;
  signals.input = input_, signals.force = force_;
  return signals;
}

void EvenPath::to_rows(std::vector<float>& mean, std::vector<float>& change) const {
  const OverSamples on_rows =
      over_other_intervals({{mean.begin(), mean.end()}, {change.begin(), change.end()}}, even_edges_, edges_);
  mean.assign(on_rows.mean.begin(), on_rows.mean.end());
  change.assign(on_rows.change.begin(), on_rows.change.end());
}

}  // namespace loopwright::diagnosis
