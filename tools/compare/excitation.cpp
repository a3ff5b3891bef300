#include "tools/compare/excitation.h"
#include "models/real/whole.h"
#include "tools/experiment/signal_figures.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace loopwright {
namespace {

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (double v : values) sum += v * v;
  return values.empty() ? 0 : std::sqrt(sum / double(values.size()));
}

double greatest(const std::vector<double>& values) {
  double most = 0;
  for (double v : values) most = std::max(most, std::abs(v));
  return most;
}

int directions_in(const MeasuredMotion& m) {
  double forward = 0, backward = 0;
  for (size_t k = 0; k < m.rows(); ++k)
    if (m.counts[k]) (m.velocity[k] > 0 ? forward : backward) += 1;
  const double all = forward + backward;
  return int(forward > 0.05 * all) + int(backward > 0.05 * all);
}

int speeds_in(const MeasuredMotion& m) {
  std::map<int, double> seconds;  // by the logarithm of speed
  for (size_t k = 0; k < m.rows(); ++k)
    if (m.counts[k])
      seconds[whole_between(std::floor(std::log(std::abs(m.velocity[k])) / std::log(1.2)), -10000, 10000)] +=
          m.sample_time;
  double moving = 0;
  for (const auto& [bin, s] : seconds) moving += s;
  int count = 0, last = -1000;
  for (const auto& [bin, s] : seconds)
    if (s >= std::max(0.1, 0.02 * moving) && bin > last + 1)
      ++count, last = bin;  // a speed may fall between two bins
  return count;
}

/// Spread of the force at the same position and direction, relative to its overall spread.
bool has_varied_force(const MeasuredMotion& m) {
  constexpr int bins = 50;
  std::vector<double> sum(2 * bins), squares(2 * bins), count(2 * bins);
  const double low = *std::ranges::min_element(m.position), stroke = std::max(m.stroke(), 1e-300);
  for (size_t k = 0; k < m.rows(); ++k) {
    if (!m.counts[k]) continue;
    const auto bin =
        whole_index((m.position[k] - low) / stroke * bins, bins) + size_t(m.velocity[k] > 0 ? bins : 0);
    sum[bin] += m.force[k], squares[bin] += m.force[k] * m.force[k], count[bin] += 1;
  }
  double within = 0, all = 0;
  for (size_t b = 0; b < sum.size(); ++b)
    if (count[b] > 1) within += squares[b] - sum[b] * sum[b] / count[b], all += squares[b];
  return within > 0.05 * all;
}

/// Whether the input takes few values, as a command in steps, which stands at its greatest as at any other.
bool is_in_steps(const std::vector<double>& input, double width) {
  constexpr size_t most_levels = 10;
  std::vector<double> levels;
  for (const double u : input) {
    const auto is_same = [&](double level) { return std::abs(u - level) <= width; };
    if (std::ranges::any_of(levels, is_same)) continue;
    if (levels.size() == most_levels) return false;
    levels.push_back(u);
  }
  return true;
}

/// Fraction of the rows on which the input stays at its highest or lowest value.
double saturated_part(const MeasuredMotion& m) {
  const auto [low, high] = std::ranges::minmax(m.input);
  const double width = 1e-6 * (high - low);
  if (low == high || is_in_steps(m.input, width)) return 0;
  size_t rows = 0;
  for (size_t k = 2; k < m.rows(); ++k) {
    const auto all = [&](auto is) { return is(m.input[k]) && is(m.input[k - 1]) && is(m.input[k - 2]); };
    rows += (high > 0 && all([&](double u) { return u >= high - width; })) ||
            (low < 0 && all([&](double u) { return u <= low + width; }));
  }
  return double(rows) / double(m.rows());
}

/// Shifts are tried in such steps, and told if they are at least two steps and so long [s].
constexpr double lag_step_s = 1e-3, least_late_s = 7.5e-3;

/// The mean over the rows that count.
double mean_of(const MeasuredMotion& m, const std::vector<double>& values) {
  double sum = 0, n = 0;
  for (size_t k = 0; k < m.rows(); ++k)
    if (m.counts[k]) sum += values[k], n += 1;
  return sum / std::max(n, 1.0);
}

/// The force produced by the input compared with the force that the model needs: slope, correlation, and time
/// shift in samples. A weight that the input holds is in both, and says nothing of units and signs: what
/// counts is how they change.
struct InputMatch {
  double slope = 0, correlation = 0;
  int late_samples = 0;
  double gained = 0;  ///< fraction of the squared difference removed by the shift
  /// A larger shift might fit better: then it is not a time shift, but a slow missing force.
  bool is_at_end = false;
};
InputMatch match_input(const MeasuredMotion& m, const ForceResidual& residual) {
  std::vector<double> needed(m.rows());
  for (size_t k = 0; k < m.rows(); ++k) needed[k] = m.force[k] - residual.value[k];
  const int most = whole_between(std::ceil(0.1 / m.sample_time), 0, int(m.rows()));
  const int step = std::max(1, whole_between(std::round(lag_step_s / m.sample_time), 0, most));
  InputMatch match;
  const double held = mean_of(m, m.force), needs_to_hold = mean_of(m, needed);
  double at_zero = 0, best = 1e300;
  for (int lag = -(most / step) * step; lag <= most; lag += step) {
    double uf = 0, uu = 0, ff = 0;
    for (size_t k = 0; k < m.rows(); k += size_t(step)) {
      const ptrdiff_t other = ptrdiff_t(k) - lag;
      if (!m.counts[k] || other < 0 || other >= ptrdiff_t(m.rows())) continue;
      const double u = m.force[size_t(other)] - held, f = needed[k] - needs_to_hold;
      uf += u * f, uu += u * u, ff += f * f;
    }
    const double left = ff > 0 ? (uu + ff - 2 * uf) / ff : 0;
    if (lag == 0) {
      match.slope = ff > 0 ? uf / ff : 0, match.correlation = uf / std::sqrt(std::max(uu * ff, 1e-300));
      at_zero = left;
    }
    if (left < best) best = left, match.late_samples = lag;
  }
  match.gained = at_zero > 0 ? 1 - best / at_zero : 0;
  match.is_at_end = std::abs(match.late_samples) + step > most;
  return match;
}

void check_input(const MeasuredMotion& m, const ForceResidual& residual, std::vector<RecordFault>& faults) {
  const InputMatch match = match_input(m, residual);
  const double size = std::abs(match.slope);
  if (match.slope < 0 && match.correlation < -0.4)
    faults.push_back(
        {"wrong_sign", "the recorded input pushes against the motion that it should cause",
         "nothing can be read from the residual until the sign of the input or of the position is turned",
         true});
  else if (std::abs(match.correlation) > 0.7 && (size > 5 || size < 0.2))
    faults.push_back(
        {"wrong_unit",
         fmt::format("the recorded input makes {:.3g} times the force that the model needs", size),
         "the residual is mostly this factor: check the units of the input and of the position, the scale of "
         "the sensor, the gain between input and force, or the mass of the model",
         size > 20 || size < 0.05});
  const double late_s = match.late_samples * m.sample_time;
  if (std::abs(match.late_samples) > 1 && std::abs(late_s) >= least_late_s && match.gained > 0.6 &&
      match.slope > 0 && !match.is_at_end)
    faults.push_back(
        {"unsynchronised", fmt::format("input and motion fit best when shifted by {:.3g} ms", 1e3 * late_s),
         "effects that depend on acceleration or on fast changes of the input cannot be told from this "
         "shift; check that both columns share a clock",
         late_s < 0,  // no machine moves before its input, but a load on a spring looks like it
         late_s < 0});
}

}  // namespace

int reversals_in(const MeasuredMotion& m) {
  int count = 0;
  double direction = 0;
  for (size_t k = 0; k < m.rows(); ++k) {
    if (std::abs(m.velocity[k]) <= m.rest_speed) continue;
    const double now = m.velocity[k] > 0 ? 1 : -1;
    count += direction != 0 && now != direction;
    direction = now;
  }
  return count;
}

RecordContent content_of(const Machine& machine, const ForceResidual& residual, double resolution) {
  const MeasuredMotion& m = machine.motion;
  RecordContent c;
  c.sizes.stroke = m.stroke(), c.sizes.resolution = resolution;
  c.sizes.lowest_position = *std::ranges::min_element(m.position);
  c.sizes.highest_position = *std::ranges::max_element(m.position);
  c.sizes.top_speed = greatest(m.velocity), c.sizes.top_acceleration = greatest(m.acceleration);
  c.sizes.force_level = rms(m.force), c.sizes.input_level = rms(m.input);
  c.sizes.machine_mass = machine.mass;
  c.sizes.duration = double(m.rows()) * m.sample_time, c.sizes.sample_time = m.sample_time;
  c.sizes.initial_position = m.position.front(), c.sizes.initial_velocity = m.velocity.front();
  c.directions = directions_in(m), c.speeds = speeds_in(m), c.reversals = reversals_in(m);
  double up = 0, down = 0;
  for (size_t k = 0; k < m.rows(); ++k)
    if (m.counts[k]) up = std::max(up, m.acceleration[k]), down = std::min(down, m.acceleration[k]);
  const double clear = 5 * residual.noise_floor / std::max(machine.mass, 1e-300);
  c.accelerations = int(up > clear) + int(-down > clear);
  c.passes = residual.repeat_s > 0 ? int(whole_count(c.sizes.duration / residual.repeat_s)) : 1;
  c.varied_force = has_varied_force(m);
  return c;
}

std::vector<Identifiability> identifiable(const RecordContent& c, const std::vector<Effect>& catalogue) {
  std::vector<Identifiability> result;
  for (const Effect& effect : catalogue) {
    if (!result.empty() && result.back().effect == effect.name) continue;  // its forms need the same
    Identifiability entry{effect.name};
    const auto need = [&](bool is_met, std::string what) {
      if (is_met) return;
      entry.can_be_found = false;
      entry.lacks += (entry.lacks.empty() ? "" : "; ") + what;
    };
    const Excitation& e = effect.needs;
    need(c.directions >= e.directions, "motion in both directions");
    need(c.speeds >= e.speeds,
         fmt::format("{} different speeds (there {} {})", e.speeds, c.speeds == 1 ? "is" : "are", c.speeds));
    need(c.accelerations >= e.accelerations, "acceleration and deceleration well above the noise");
    need(c.reversals >= e.reversals, fmt::format("{} reversals (there are {})", e.reversals, c.reversals));
    need(c.passes >= e.passes || c.sizes.duration > 60, "the same motion early and late");
    need(c.sizes.duration >= e.duration_s, fmt::format("{:g} s of record", e.duration_s));
    need(!e.varied_force || c.varied_force, "different forces at the same places");
    result.push_back(std::move(entry));
  }
  return result;
}

namespace {

/// Of what one record may lack and another contain.
std::vector<RecordFault> common_faults(const MeasuredMotion& m, const RecordContent& c) {
  std::vector<RecordFault> faults;
  const double moving = double(std::ranges::count(m.counts, 1)) * m.sample_time;
  if (c.sizes.duration < 2 || moving < 1)
    faults.push_back({"too_short", fmt::format("the machine moves for {:.2g} s in all", moving),
                      "shares and noise floor are rough; no effect should be named from this record", true});
  if (c.directions < 2)
    faults.push_back(
        {"one_direction", "all motion goes one way",
         "while it moves, Coulomb friction, a constant force and direction-dependent friction look alike"});
  if (c.speeds < 2)
    faults.push_back({"one_speed", "nearly all motion is at one speed",
                      "friction of any kind, drag and periodic errors of force or encoder look alike"});
  if (const double part = saturated_part(m); part > 0.01)
    faults.push_back(
        {"saturated", fmt::format("the input stands at its limit for {:.1f} % of the record", 100 * part),
         "the controller is out of the loop there; the recorded command may not be the force that acted"});
  return faults;
}

std::vector<RecordFault> own_faults(const MeasuredMotion& m, const ForceResidual& residual) {
  std::vector<RecordFault> faults;
  size_t gaps = 0;
  for (size_t k = 0; k < m.rows(); ++k) gaps += m.is_missing(k) && (k == 0 || !m.is_missing(k - 1));
  const auto lost = std::ranges::count(m.missing, char(1));
  if (gaps > 0)
    faults.push_back({"gaps",
                      fmt::format("{} sample{} {} missing at {} place{}", lost, lost == 1 ? "" : "s",
                                  lost == 1 ? "is" : "are", gaps, gaps == 1 ? "" : "s"),
                      "a held input is taken as held there, and the rows beside the gaps do not count"});
  if (const size_t count = outliers(m.raw_position).size(); count > 0)
    faults.push_back(
        {"outliers",
         fmt::format("{} sample{} of the position leap out of line", count, count == 1 ? "" : "s"),
         "each spoils the residual for some hundredths of a second around it"});
  check_input(m, residual, faults);
  return faults;
}

/// Motions as one; the rows at the seams do not count.
MeasuredMotion one_after_the_other(const std::vector<RecordView>& records) {
  MeasuredMotion all = records.front().motion;
  all.missing.clear();
  for (size_t r = 1; r < records.size(); ++r) {
    const MeasuredMotion& m = records[r].motion;
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(all.time, m.time), append(all.position, m.position), append(all.velocity, m.velocity);
    append(all.acceleration, m.acceleration), append(all.input, m.input), append(all.force, m.force);
    append(all.raw_position, m.raw_position), append(all.counts, m.counts);
    if (!m.counts.empty()) all.counts[all.counts.size() - m.counts.size()] = 0;
  }
  return all;
}

}  // namespace

std::vector<RecordFault> faults_of(const Machine& machine, const ForceResidual& residual,
                                   const RecordContent& c) {
  std::vector<RecordFault> faults = common_faults(machine.motion, c);
  std::ranges::move(own_faults(machine.motion, residual), std::back_inserter(faults));
  return faults;
}

RecordContent content_of(const std::vector<RecordView>& records) {
  const MeasuredMotion m = one_after_the_other(records);
  RecordContent all = records.front().content;
  all.directions = directions_in(m), all.speeds = speeds_in(m);
  for (size_t r = 1; r < records.size(); ++r) {
    const RecordContent& c = records[r].content;
    all.sizes.duration += c.sizes.duration;
    all.sizes.machine_mass = std::min(all.sizes.machine_mass, c.sizes.machine_mass);
    all.sizes.machine_damping = std::min(all.sizes.machine_damping, c.sizes.machine_damping);
    all.sizes.lowest_position = std::min(all.sizes.lowest_position, c.sizes.lowest_position);
    all.sizes.highest_position = std::max(all.sizes.highest_position, c.sizes.highest_position);
    all.sizes.top_speed = std::max(all.sizes.top_speed, c.sizes.top_speed);
    all.sizes.top_acceleration = std::max(all.sizes.top_acceleration, c.sizes.top_acceleration);
    all.accelerations = std::max(all.accelerations, c.accelerations);
    all.reversals += c.reversals, all.passes = std::max(all.passes, c.passes);
    all.varied_force |= c.varied_force;
  }
  all.sizes.stroke = all.sizes.highest_position - all.sizes.lowest_position;
  return all;
}

std::vector<RecordFault> faults_of(const std::vector<RecordView>& records) {
  std::vector<RecordFault> faults = common_faults(one_after_the_other(records), content_of(records));
  for (size_t r = 0; r < records.size(); ++r)
    for (RecordFault& fault : own_faults(records[r].motion, records[r].residual)) {
      if (records.size() > 1) fault.text = fmt::format("record {}: {}", r + 1, fault.text);
      faults.push_back(std::move(fault));
    }
  return faults;
}

}  // namespace loopwright
