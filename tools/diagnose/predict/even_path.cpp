#include "tools/diagnose/predict/even_path.h"
#include <algorithm>
#include <cmath>
#include "models/real/whole.h"

namespace loopwright::diagnosis {
namespace {

std::vector<double> mean_over(const std::vector<double>& held, const std::vector<double>& edges,
                              const std::vector<double>& others) {
  return over({edges, held, std::vector<double>(held.size())}, others).mean;
}

}  // namespace

LinesOver over(const LinesOver& lines, std::vector<double> edges) {
  const size_t count = edges.size() - 1, last = lines.mean.size() - 1;
  LinesOver result{std::move(edges), std::vector<double>(count), std::vector<double>(count)};
  for (size_t k = 0, i = 0; k < count; ++k) {
    const double begin = result.edges[k], end = result.edges[k + 1], length = end - begin;
    double area = 0, moment = 0;
    for (double from = begin; from < end;) {
      while (i < last && lines.edges[i + 1] <= from) ++i;
      const double to = i < last ? std::min(end, lines.edges[i + 1]) : end, part = to - from;
      const double slope = lines.change[i] / (lines.edges[i + 1] - lines.edges[i]);
      const double centre = 0.5 * (from + to);
      const double value = lines.mean[i] + slope * (centre - 0.5 * (lines.edges[i] + lines.edges[i + 1]));
      area += part * value;
      moment += part * value * (centre - 0.5 * (begin + end)) + slope * part * part * part / 12;
      from = to;
    }
    result.mean[k] = area / length, result.change[k] = 12 * moment / (length * length);
  }
  return result;
}

EvenPath::EvenPath(const Path& path) {
  edges_.push_back(0);
  for (const double duration : path.duration) edges_.push_back(edges_.back() + duration);
  const size_t rows = std::max<size_t>(1, whole_count(std::ceil(edges_.back())));
  for (size_t i = 0; i <= rows; ++i) even_edges_.push_back(double(i));
  for (size_t i = 0, row = 0; i < rows; ++i) {
    const auto distance = [&](size_t k) { return std::abs(double(i) - edges_[k]); };
    while (row + 1 < path.samples() && distance(row + 1) < distance(row)) ++row;
    const double later = (double(i) - edges_[row]) * path.sample_time;
    const double v = path.velocity[row], a = path.acceleration[row];
    position_.push_back(path.position[row] + (v + 0.5 * a * later) * later);
    velocity_.push_back(v + a * later);
  }
  acceleration_ = mean_over(path.acceleration, edges_, even_edges_);
  if (!path.input.empty()) input_ = mean_over(path.input, edges_, even_edges_);
  if (!path.force.empty()) force_ = mean_over(path.force, edges_, even_edges_);
}

RoleSignals EvenPath::signals() const {
  RoleSignals signals;
  signals.position = position_, signals.velocity = velocity_, signals.acceleration = acceleration_;
  signals.input = input_, signals.force = force_;
  return signals;
}

void EvenPath::to_rows(std::vector<float>& mean, std::vector<float>& change) const {
  const LinesOver on_rows =
      over({even_edges_, {mean.begin(), mean.end()}, {change.begin(), change.end()}}, edges_);
  mean.assign(on_rows.mean.begin(), on_rows.mean.end());
  change.assign(on_rows.change.begin(), on_rows.change.end());
}

}  // namespace loopwright::diagnosis
