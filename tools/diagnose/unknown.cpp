#include "tools/diagnose/unknown.h"
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace loopwright::diagnosis {
namespace {

using Variable = std::function<double(const Path&, size_t)>;

double middle_velocity(const Path& path, size_t k) {
  return path.velocity[k] + 0.5 * path.sample_time * path.acceleration[k];
}
double middle_position(const Path& path, size_t k) {
  return path.position[k] + 0.5 * path.sample_time * path.velocity[k];
}

/// Σ level_i · B_i(variable) · factor: a cubic spline over even intervals.
Candidate spline(std::string variables, size_t levels, double low, double high, Variable variable,
                 Variable factor) {
  Candidate candidate;
  candidate.name = "unknown", candidate.form = std::move(variables), candidate.is_unknown = true;
  for (size_t i = 0; i < levels; ++i) candidate.linear.push_back({"level", "", -1e300, 1e300, false, {}});
  candidate.columns_at = [=](const Path& path, const std::vector<std::vector<double>>& shapes) {
    Columns columns(levels, std::vector<float>(path.samples()));
    const size_t intervals = levels - 3;
    for (size_t k = 0; k < path.samples(); ++k) {
      const double at = std::clamp((variable(path, k) - low) / (high - low), 0.0, 1.0) * double(intervals);
      const size_t i = std::min(size_t(at), intervals - 1);
      const double t = at - double(i), left = 1 - t, size = factor(path, k) / 6;
      columns[i][k] = float(size * left * left * left);
      columns[i + 1][k] = float(size * (4 - 3 * t * t * (2 - t)));
      columns[i + 2][k] = float(size * (4 - 3 * left * left * (2 - left)));
      columns[i + 3][k] = float(size * t * t * t);
    }
    return std::vector(shapes.size(), columns);
  };
  return candidate;
}

/// The mean of it acts like a mass, at once.
Candidate mass_along(Candidate candidate) {
  candidate.added_inertia = [](const Member& member) {
    return std::accumulate(member.linear.begin(), member.linear.end(), 0.0) / double(member.linear.size());
  };
  return candidate;
}

Candidate tone(const RecordSizes& sizes) {
  Candidate candidate;
  candidate.name = "unknown", candidate.form = "time", candidate.is_unknown = true;
  candidate.is_periodic = candidate.repeats_in_time = true;
  candidate.linear = {{"sine", "", -1e300, 1e300, false, {}}, {"cosine", "", -1e300, 1e300, false, {}}};
  const double shortest = 10 * sizes.sample_time, longest = sizes.duration / 4;
  candidate.nonlinear = {
      {"period", "s", shortest, longest, true, {std::sqrt(shortest * longest)}, sizes.duration}};
  candidate.columns_at = [](const Path& path, const std::vector<std::vector<double>>& shapes) {
    std::vector<Columns> result;
    for (const std::vector<double>& shape : shapes) {
      Columns& columns = result.emplace_back(2, std::vector<float>(path.samples()));
      for (size_t k = 0; k < path.samples(); ++k) {
        const double angle = 2 * std::numbers::pi * (double(k) + 0.5) * path.sample_time / shape[0];
        columns[0][k] = float(std::sin(angle)), columns[1][k] = float(std::cos(angle));
      }
    }
    return result;
  };
  return candidate;
}

}  // namespace

std::vector<Candidate> unknown_forces(const RecordSizes& sizes) {
  const double low = sizes.lowest_position, high = sizes.highest_position, top = sizes.top_speed;
  const Variable one = [](const Path&, size_t) { return 1.0; };
  const Variable direction = [](const Path& path, size_t k) {
    return middle_velocity(path, k) > 0 ? 1.0 : -1.0;
  };
  const Variable acceleration = [](const Path& path, size_t k) { return path.acceleration[k]; };
  const Variable time = [](const Path& path, size_t k) { return double(k) * path.sample_time; };
  return {spline("position", 60, low, high, middle_position, one),
          spline("velocity", 24, -top, top, middle_velocity, one),
          spline("time", 40, 0, sizes.duration, time, one),
          spline("position,direction", 24, low, high, middle_position, direction),
          spline("position,velocity", 24, low, high, middle_position, middle_velocity),
          mass_along(spline("position,acceleration", 24, low, high, middle_position, acceleration)),
          tone(sizes)};
}

}  // namespace loopwright::diagnosis
