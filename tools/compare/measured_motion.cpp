#include "tools/compare/measured_motion.h"
#include <algorithm>
#include <cmath>
#include "models/real/whole.h"
#include "tools/compare/zero_phase.h"

namespace loopwright {
namespace {

std::vector<double> central_difference(const std::vector<double>& x, double dt) {
  std::vector<double> v(x.size());
  for (size_t k = 1; k + 1 < x.size(); ++k) v[k] = (x[k + 1] - x[k - 1]) / (2 * dt);
  v.front() = v[1], v.back() = v[v.size() - 2];
  return v;
}

std::vector<double> second_difference(const std::vector<double>& x, double dt) {
  std::vector<double> a(x.size());
  for (size_t k = 1; k + 1 < x.size(); ++k) a[k] = (x[k + 1] - 2 * x[k] + x[k - 1]) / (dt * dt);
  a.front() = a[1], a.back() = a[a.size() - 2];
  return a;
}

/// Rows fast enough for the sign of friction to be certain, and 12 ms away from rest and from missing
/// samples: the range of the filters.
void find_moving_rows(MeasuredMotion& m) {
  const size_t n = m.rows(), margin = whole_count(std::ceil(0.012 / m.sample_time)),
               ends = std::min(n / 10, whole_count(std::ceil(0.1 / m.sample_time)));
  m.rest_speed = 0.005 * m.top_speed();
  m.counts.assign(n, 1);
  for (size_t k = 0; k < n; ++k) {
    if (k < ends || k + ends >= n) m.counts[k] = 0;
    if (std::abs(m.velocity[k]) > m.rest_speed && !m.is_missing(k)) continue;
    for (size_t i = k > margin ? k - margin : 0; i <= std::min(n - 1, k + margin); ++i) m.counts[i] = 0;
  }
}

}  // namespace

void smooth_motion(MeasuredMotion& m) {
  m.cutoff = std::min(200.0, 0.2 / m.sample_time);
  if (!m.raw_position.empty()) {
    m.position = zero_phase_low_pass(m.raw_position, m.cutoff, m.sample_time);
    m.velocity = central_difference(m.position, m.sample_time);
    m.acceleration = second_difference(m.position, m.sample_time);
  } else {
    m.velocity = zero_phase_low_pass(m.velocity, m.cutoff, m.sample_time);
    m.acceleration = central_difference(m.velocity, m.sample_time);
    m.position.assign(1, 0.0);
    for (size_t k = 1; k < m.velocity.size(); ++k)
      m.position.push_back(m.position.back() + 0.5 * m.sample_time * (m.velocity[k - 1] + m.velocity[k]));
    m.raw_position = m.position;
  }
  find_moving_rows(m);
}

void shift_position(MeasuredMotion& m, double by) {
  for (auto* list : {&m.position, &m.raw_position})
    for (double& place : *list) place += by;
}

double MeasuredMotion::stroke() const {
  const auto [low, high] = std::ranges::minmax(position);
  return high - low;
}
double MeasuredMotion::top_speed() const {
  double top = 0;
  for (double v : velocity) top = std::max(top, std::abs(v));
  return top;
}

}  // namespace loopwright
