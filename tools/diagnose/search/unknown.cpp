#include "tools/diagnose/search/unknown.h"
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace loopwright::diagnosis {
namespace {

/// One value per sample.
using Variable = std::function<std::vector<double>(const Path&)>;

template <class F> Variable each_sample(F&& of) {
  return [of](const Path& path) {
    std::vector<double> values(path.samples());
    for (size_t k = 0; k < values.size(); ++k) values[k] = of(path, k);
    return values;
  };
}

double middle_velocity(const Path& path, size_t k) {
  return path.velocity[k] + 0.5 * path.sample_time * path.acceleration[k];
}
double middle_position(const Path& path, size_t k) {
  return path.position[k] + 0.5 * path.sample_time * path.velocity[k];
}

/// From -1 to 1, with a transition as short as in the catalogue's dry friction: an unnamed function must not
/// win by its behavior at reversals.
Variable direction_of(double transition_distance) {
  return [=](const Path& path) {
    std::vector<double> values(path.samples());
    double fraction = 0;
    for (size_t k = 1; k < values.size(); ++k) {
      const double way = middle_position(path, k) - middle_position(path, k - 1), sign = way < 0 ? -1 : 1;
      const double left = std::exp(-std::abs(way) / transition_distance);
      fraction = sign + (fraction - sign) * left, values[k] = fraction;
    }
    return values;
  };
}

/// The four spline functions that are not zero at a fraction of the range, and the first one's index.
struct SplinePieces {
  size_t first;
  double value[spline_degree + 1];
};
SplinePieces spline_pieces(size_t levels, double fraction) {
  const size_t intervals = levels - spline_degree;
  const double at = std::clamp(fraction, 0.0, 1.0) * double(intervals);
  const size_t i = std::min(size_t(at), intervals - 1);
  const double t = at - double(i), left = 1 - t;
  return {i,
          {left * left * left / 6, (4 - 3 * t * t * (2 - t)) / 6, (4 - 3 * left * left * (2 - left)) / 6,
           t * t * t / 6}};
}

/// Σ level_i · B_i(variable) · factor: a cubic spline over uniform intervals.
Candidate spline(std::string variables, size_t levels, double low, double high, Variable variable,
                 Variable factor) {
  Candidate candidate;
  candidate.name = "unknown", candidate.form = std::move(variables), candidate.is_unknown = true,
  candidate.at_rest = AtRest::gives;
  for (size_t i = 0; i < levels; ++i) candidate.linear.push_back({"level", "", -1e300, 1e300, false, {}});
  candidate.columns_at = [=](const Path& path, const std::vector<std::vector<double>>& shapes) {
    std::vector<std::vector<float>> values(levels, std::vector<float>(path.samples()));
    const std::vector<double> along = variable(path), factors = factor(path);
    for (size_t k = 0; k < path.samples(); ++k) {
      const SplinePieces pieces = spline_pieces(levels, (along[k] - low) / (high - low));
      for (size_t i = 0; i <= spline_degree; ++i)
        values[pieces.first + i][k] = float(factors[k] * pieces.value[i]);
    }
    Columns columns;
    for (std::vector<float>& column : values) columns.emplace_back(std::move(column));
    return std::vector(shapes.size(), columns);
  };
  return candidate;
}

/// Its mean acts like a mass, without delay.
Candidate mass_along(Candidate candidate) {
  candidate.added_inertia = [](const Member& member) {
    return std::accumulate(member.linear.begin(), member.linear.end(), 0.0) / double(member.linear.size());
  };
  return candidate;
}

Candidate tone(const RecordSizes& sizes) {
  Candidate candidate;
  candidate.name = "unknown", candidate.form = "time", candidate.is_unknown = true,
  candidate.at_rest = AtRest::gives;
  candidate.is_periodic = candidate.repeats_in_time = true;
  candidate.linear = {{"sine", "", -1e300, 1e300, false, {}}, {"cosine", "", -1e300, 1e300, false, {}}};
  const double shortest = 10 * sizes.sample_time, longest = sizes.duration / 4;
  candidate.nonlinear = {
      {"period", "s", shortest, longest, true, {std::sqrt(shortest * longest)}, sizes.duration}};
  candidate.columns_at = [](const Path& path, const std::vector<std::vector<double>>& shapes) {
    std::vector<Columns> result;
    const std::vector<double> time = times_of(path);
    for (const std::vector<double>& shape : shapes) {
      std::vector<float> sine(path.samples()), cosine(path.samples());
      for (size_t k = 0; k < path.samples(); ++k) {
        const double angle = std::numbers::pi * (time[k] + time[k + 1]) / shape[0];
        sine[k] = float(std::sin(angle)), cosine[k] = float(std::cos(angle));
      }
      result.push_back({Column(std::move(sine)), Column(std::move(cosine))});
    }
    return result;
  };
  return candidate;
}

/// From an instant on.
Candidate jump(const RecordSizes& sizes) {
  constexpr double step = 0.3;  // [samples] The instant acts within one
  Candidate candidate;
  candidate.name = "unknown", candidate.form = "time", candidate.is_unknown = candidate.jumps = true,
  candidate.at_rest = AtRest::gives;
  candidate.linear = {{"level", "", -1e300, 1e300, false, {}}};
  CandidateParameter instant{"instant", "s", 0, sizes.duration, false, {}};
  instant.step = step * sizes.sample_time;
  candidate.nonlinear = {instant};
  candidate.columns_at = [](const Path& path, const std::vector<std::vector<double>>& shapes) {
    std::vector<Columns> result;
    const std::vector<double> time = times_of(path);
    for (const std::vector<double>& shape : shapes) {
      std::vector<float> level(path.samples());
      for (size_t k = 0; k < path.samples(); ++k)
        level[k] = float(std::clamp((time[k + 1] - shape[0]) / (time[k + 1] - time[k]), 0.0, 1.0));
      result.push_back({Column(std::move(level))});
    }
    return result;
  };
  return candidate;
}

}  // namespace

std::pair<double, double> range_of_time(const RecordSizes& sizes) {
  return {std::min(criteria::settling_s, 0.5 * sizes.duration), sizes.duration};
}

std::vector<double> times_of(const Path& path) {
  std::vector<double> times{0};
  for (size_t k = 0; k < path.samples(); ++k)
    times.push_back(times[k] + path.sample_time * (path.duration.empty() ? 1 : path.duration[k]));
  return times;
}

double spline_at(const std::vector<double>& levels, double fraction) {
  const SplinePieces pieces = spline_pieces(levels.size(), fraction);
  double sum = 0;
  for (size_t i = 0; i <= spline_degree; ++i) sum += levels[pieces.first + i] * pieces.value[i];
  return sum;
}

double transition_of_direction(const RecordSizes& sizes) {
  return std::max(1e-6 * sizes.stroke, sizes.resolution);
}

std::vector<Candidate> unknown_forces(const RecordSizes& sizes, bool is_map, bool has_mass) {
  const double low = sizes.lowest_position, high = sizes.highest_position, top = sizes.top_speed;
  const Variable one = each_sample([](const Path&, size_t) { return 1.0; });
  const Variable acceleration = each_sample([](const Path& path, size_t k) { return path.acceleration[k]; });
  const Variable time = [](const Path& path) {
    std::vector<double> middle = times_of(path);
    for (size_t k = 0; k < path.samples(); ++k) middle[k] = 0.5 * (middle[k] + middle[k + 1]);
    return middle;
  };
  const Variable position = each_sample(middle_position), velocity = each_sample(middle_velocity);
  const Variable direction = direction_of(transition_of_direction(sizes));
  Candidate of_velocity = spline("velocity", 24, -top, top, velocity, one);
  of_velocity.law_of = LawOf::velocity;
  Candidate of_position = spline("position", 60, low, high, position, one);
  of_position.law_of = LawOf::position;
  const Candidate of_direction = spline("position,direction", 24, low, high, position, direction);
  if (is_map) return {of_position, of_direction};
  Candidate of_acceleration = spline("position,acceleration", 24, low, high, position, acceleration);
  if (has_mass) of_acceleration = mass_along(std::move(of_acceleration));
  return {of_position,
          std::move(of_velocity),
          spline("time", 40, range_of_time(sizes).first, range_of_time(sizes).second, time, one),
          of_direction,
          spline("position,velocity", 24, low, high, position, velocity),
          std::move(of_acceleration),
          tone(sizes),
          jump(sizes)};
}

}  // namespace loopwright::diagnosis
