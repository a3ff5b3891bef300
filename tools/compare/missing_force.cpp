#include "tools/compare/missing_force.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include "tools/compare/smoother.h"
#include "tools/compare/zero_phase.h"
#include "tools/experiment/signal_figures.h"
#include "models/real/whole.h"

namespace loopwright {
namespace {

double rms_where(const std::vector<double>& values, const std::vector<char>& counts) {
  double sum = 0;
  size_t n = 0;
  for (size_t k = 0; k < values.size(); ++k)
    if (counts[k]) sum += values[k] * values[k], ++n;
  return n ? std::sqrt(sum / double(n)) : 0;
}

/// Half of the spread between repetitions; needs no model.
double floor_of_repeats(const MeasuredMotion& m, const std::vector<double>& r, size_t lag) {
  double sum = 0;
  size_t n = 0;
  for (size_t k = 0; k + lag < r.size(); ++k)
    if (m.counts[k] && m.counts[k + lag]) sum += 0.5 * (r[k + lag] - r[k]) * (r[k + lag] - r[k]), ++n;
  return n ? std::sqrt(sum / double(n)) : 0;
}

std::array<std::vector<double>, 6> variables_of(const MeasuredMotion& m) {
  std::vector<double> direction;
  for (double v : m.velocity) direction.push_back(v > 0 ? 1 : -1);
  return {m.position, m.velocity, m.acceleration, direction, m.input, m.time};
}
constexpr std::array<const char*, 6> variable_names = {"position",  "velocity", "acceleration",
                                                       "direction", "input",    "time"};

}  // namespace

NoiseFloor noise_floor(const MeasuredMotion& m, const std::vector<double>& residual) {
  NoiseFloor floor;
  if (const size_t lag = rows_until_repeat(m.position, m.sample_time); lag > 0) {
    floor.repeat_s = double(lag) * m.sample_time;
    floor.value = floor_of_repeats(m, residual, lag);
    floor.source = fmt::format("the spread between repeats of the motion, {:.4g} s apart", floor.repeat_s);
  }
  if (floor.value > 0) return floor;
  floor.value = floor_of_smooth_parts(thinned(m, residual));
  floor.source =
      "what smooth functions of position, velocity, acceleration and time leave; a repeated "
      "motion would tell it without a model";
  return floor;
}

ForceResidual force_residual(const Machine& machine, const std::vector<double>& acceleration) {
  const MeasuredMotion& m = machine.motion;
  ForceResidual result;
  result.cutoff = std::min(80.0, 0.08 / m.sample_time);
  // The second difference of the position at k is the mean of the accelerations over the two adjacent
  // samples.
  std::vector<double> model(m.rows());
  for (size_t k = 0; k < m.rows(); ++k) model[k] = 0.5 * (acceleration[k ? k - 1 : 0] + acceleration[k]);
  model = zero_phase_low_pass(model, m.cutoff, m.sample_time);
  for (size_t k = 0; k < m.rows(); ++k) result.value.push_back(machine.mass * (model[k] - m.acceleration[k]));
  result.value = zero_phase_low_pass(result.value, result.cutoff, m.sample_time);
  result.rmse = rms_where(result.value, m.counts);
  const double driving = rms_where(m.force, m.counts);
  result.relative_percent = driving > 0 ? 100 * result.rmse / driving : 0;
  const NoiseFloor floor = noise_floor(m, result.value);
  result.noise_floor = floor.value, result.repeat_s = floor.repeat_s, result.floor_source = floor.source;
  return result;
}

std::vector<Segment> segments(const MeasuredMotion& m) {
  double top = 0;
  for (double a : zero_phase_low_pass(m.acceleration, std::min(20.0, 0.02 / m.sample_time), m.sample_time))
    top = std::max(top, std::abs(a));
  const std::vector<double> smooth =
      zero_phase_low_pass(m.acceleration, std::min(20.0, 0.02 / m.sample_time), m.sample_time);
  std::vector<Segment> result(m.rows());
  for (size_t k = 0; k < m.rows(); ++k) {
    const double v = m.velocity[k], a = smooth[k];
    const bool is_slow = std::abs(v) <= m.rest_speed, is_steady = std::abs(a) < 0.05 * top;
    result[k] = is_slow              ? (is_steady ? Segment::rest : Segment::reversal)
                : is_steady          ? Segment::constant_speed
                : (a > 0) == (v > 0) ? Segment::acceleration
                                     : Segment::deceleration;
  }
  return result;
}

std::string_view name_of(Segment segment) {
  constexpr std::array<std::string_view, 5> names = {"rest", "acceleration", "constant speed", "deceleration",
                                                     "reversal"};
  return names[size_t(segment)];
}

std::vector<ResidualShare> where_it_lies(const Machine& machine, const ForceResidual& residual) {
  const MeasuredMotion& m = machine.motion;
  std::vector<ResidualShare> shares;
  double total = 0, rows = 0;
  for (size_t k = 0; k < m.rows(); ++k)
    if (m.counts[k]) total += residual.value[k] * residual.value[k], ++rows;
  if (total == 0) return shares;
  const std::vector<Segment> parts = segments(m);
  double all = 0;
  for (double r : residual.value) all += r * r;
  for (int part = 0; part < 5; ++part) {  // segments cover the whole record, including rest and reversal
    ResidualShare share{"segment", std::string(name_of(Segment(part)))};
    for (size_t k = 0; k < m.rows(); ++k)
      if (parts[k] == Segment(part))
        share.share += residual.value[k] * residual.value[k] / all, share.of_rows += 1 / double(m.rows());
    shares.push_back(share);
  }
  const auto variables = variables_of(m);
  for (size_t v = 0; v < variables.size(); ++v) {
    const bool is_direction = std::string_view(variable_names[v]) == "direction";
    const int bins = is_direction ? 2 : 10;
    double low = 1e300, high = -1e300;
    for (size_t k = 0; k < m.rows(); ++k)
      if (m.counts[k]) low = std::min(low, variables[v][k]), high = std::max(high, variables[v][k]);
    if (!(low < high)) continue;
    std::vector<ResidualShare> own;
    for (int b = 0; b < bins; ++b) {
      own.push_back({variable_names[v], is_direction ? (b ? "forward" : "backward") : "",
                     low + (high - low) * b / bins, low + (high - low) * (b + 1) / bins});
    }
    for (size_t k = 0; k < m.rows(); ++k) {
      if (!m.counts[k]) continue;
      const int b = whole_between((variables[v][k] - low) / (high - low) * bins, 0, bins - 1);
      own[size_t(b)].share += residual.value[k] * residual.value[k] / total,
          own[size_t(b)].of_rows += 1 / rows;
    }
    shares.insert(shares.end(), own.begin(), own.end());
  }
  return shares;
}

/// [mean square of the residual] Less beside a constant depends on nothing that matters.
constexpr double least_beside_constant = 0.005;

std::vector<Dependence> dependences(const Machine& machine, const ForceResidual& residual) {
  const MeasuredMotion& m = machine.motion;
  const auto variables = variables_of(m);
  Rows rows = thinned(m, residual.value);
  // An offset is a function of every variable, and none of them explains it.
  double mean = 0, square = 0;
  for (double r : rows.residual)
    mean += r / double(rows.residual.size()), square += r * r / double(rows.residual.size());
  for (double& r : rows.residual) r -= mean;
  const double rest = square > 0 ? 1 - mean * mean / square : 1;
  std::vector<Dependence> result;
  for (size_t v = 0; v < variables.size(); ++v) {
    std::vector<double> column;
    for (size_t k : rows.index) column.push_back(variables[v][k]);
    result.push_back(explained_by(rows, variable_names[v], column));
  }
  const Dependence line = strongest_line(rows, "spatial_frequency", rows.position);
  result.push_back(line);
  if (line.share > result[0].share)
    result[0].share = line.share;  // a fine pattern is also a function of position
  result.push_back(strongest_line(rows, "temporal_frequency", rows.time));
  if (rest < least_beside_constant)
    for (Dependence& d : result) d.share = 0;
  result.push_back({"offset", 1 - rest});
  return result;
}

}  // namespace loopwright
