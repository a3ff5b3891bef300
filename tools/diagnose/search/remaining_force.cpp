#include "tools/diagnose/search/remaining_force.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include "tools/compare/zero_phase.h"
#include "models/real/whole.h"
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

constexpr double turn = 2 * std::numbers::pi;
double force_cutoff(double sample_time) { return std::min(80.0, 0.08 / sample_time); }

/// Gain of zero_phase_low_pass.
double gain_of_filter(double frequency, double cutoff, double sample_time) {
  const double ratio =
      std::tan(turn / 2 * frequency * sample_time) / std::tan(turn / 2 * cutoff * sample_time);
  return 1 / (1 + std::pow(ratio, 8));
}

/// A value held from its sample on, as seen at the sample instants: the mean of before and after. In a map it
/// belongs to its own balance.
std::vector<double> at_samples(const std::vector<double>& held, const AxisRecord& record) {
  if (record.is_map) return held;
  std::vector<double> mean = held;
  for (size_t k = held.size(); k-- > 1;) mean[k] = (held[k - 1] + held[k]) / 2;
  return mean;
}

/// The mean over each sample of what is known at its start: as the effects expect an acceleration.
std::vector<double> over_samples(const std::vector<double>& at_start) {
  std::vector<double> mean = at_start;
  for (size_t k = 0; k + 1 < mean.size(); ++k) mean[k] = (at_start[k] + at_start[k + 1]) / 2;
  return mean;
}

/// For the model along a path, at the instants of its rows.
std::vector<double> net_forces(AxisModel& model, const Path& path, const std::vector<double>& input) {
  return model.net_forces(path.position, path.velocity, input, AxisModel::At::mean);
}

}  // namespace

InverseDynamics inverse_dynamics(Trial& trial) {
  AxisModel& model = *trial.model;
  const AxisRecord& record = model.record();
  InverseDynamics result;
  result.motion = measured_motion(record);
  result.motion.force = model.driving_force(), result.motion.force_unit = model.force_unit();
  Path& path = result.path;
  if (record.is_map) {
    path = creep_along(record, record.rows());
  } else {
    path.identity = Path::next_identity(), path.sample_time = record.sample_time;
    path.position = path.predicted_position = result.motion.position;
    path.velocity = result.motion.velocity, path.acceleration = over_samples(result.motion.acceleration);
    path.input = result.motion.input;
    path.rests.resize(record.rows()), path.turns.resize(record.rows());
    for (size_t k = 0; k < record.rows(); ++k)
      path.rests[k] = std::abs(path.velocity[k]) < trial.pace.rest_speed;
  }
  path.force = model.driving_force();
  result.net_force = net_forces(model, path, path.input);
  const std::vector<double>& acceleration = record.is_map ? path.acceleration : result.motion.acceleration;
  for (size_t k = 0; k < record.rows(); ++k)
    result.residual.push_back(result.net_force[k] - model.nominal_inertia() * acceleration[k]);
  return result;
}

std::vector<double> residual_with(const Trial& trial, const InverseDynamics& inverse,
                                  const std::vector<Member>& members, double slower) {
  const AxisRecord& record = trial.model->record();
  const double T = record.sample_time, mass = trial.model->nominal_inertia() + added_inertia(members);
  std::vector<double> residual = inverse.residual;
  std::vector<double> consumed(record.rows(), 0.0);
  std::vector<Member> others;
  for (const Member& member : members) {
    if (member.candidate->acts != Acts::force) {
      others.push_back(member);
      continue;
    }
    const Columns columns = member.candidate->columns(inverse.path, member.nonlinear);
    for (size_t c = 0; c < columns.size(); ++c)
      for (size_t k = 0; k < residual.size(); ++k)
        consumed[k] += member.linear[c] * double((*columns[c].mean)[k]);
  }
  const Drives changed = drives_of(others, inverse.path, inverse.path.input);
  const std::vector<double> force = at_samples(consumed, record);
  for (size_t k = 0; k < residual.size(); ++k) residual[k] -= force[k];
  if (changed.input != inverse.path.input) {
    const std::vector<double> net = net_forces(*trial.model, inverse.path, changed.input);
    for (size_t k = 0; k < residual.size(); ++k) residual[k] += net[k] - inverse.net_force[k];
  }
  if (!changed.sensor.empty())
    for (size_t k = 1; k + 1 < residual.size(); ++k)
      residual[k] += mass * (changed.sensor[k + 1] - 2 * changed.sensor[k] + changed.sensor[k - 1]) / (T * T);
  return zero_phase_low_pass(residual, force_cutoff(T) / slower, T);
}

MeasuredMotion away_from_turns(const InverseDynamics& inverse) {
  MeasuredMotion motion = inverse.motion;
  const double T = motion.sample_time;
  const size_t reach = std::max<size_t>(1, whole_count(std::ceil(criteria::blur / (force_cutoff(T) * T))));
  size_t after = reach + 1;  // rows since the last one
  for (size_t k = 0; k < motion.rows(); ++k) {
    const bool turns = k > 0 && motion.velocity[k] * motion.velocity[k - 1] <= 0;
    after = turns || inverse.path.rests[k] ? 0 : after + 1;
    if (after > reach) continue;
    motion.counts[k] = 0;
    if (after == 0)
      std::fill(motion.counts.begin() + std::ptrdiff_t(k - std::min(k, reach)),
                motion.counts.begin() + std::ptrdiff_t(k), 0);
  }
  return motion;
}

bool balances_forces(const Trials& trials, const std::vector<InverseDynamics>& inverse) {
  double moving = 0, used = 0;
  for (size_t t = 0; t < inverse.size(); ++t) {
    moving +=
        double(std::ranges::count_if(inverse[t].motion.counts, [](auto counts) { return bool(counts); }));
    used += double(std::ranges::count_if(trials.list[t].usable, [](auto usable) { return bool(usable); }));
  }
  return moving >= criteria::least_share_in_balance * used;
}

ResidualSize residual_size(const Trials& trials, const std::vector<InverseDynamics>& inverse,
                           const std::vector<Member>& members) {
  double sum[2] = {}, n[2] = {};
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const std::vector<double> residual = residual_with(trials.list[t], inverse[t], members);
    for (size_t k = 0; k < residual.size(); ++k) {
      const int side = k >= trials.list[t].held_out_from;
      if (inverse[t].motion.counts[k]) sum[side] += residual[k] * residual[k], n[side] += 1;
    }
  }
  return {std::sqrt(sum[0] / std::max(n[0], 1.0)), n[1] > 0 ? std::sqrt(sum[1] / n[1]) : 0};
}

ForceShare share_of_force(const Trials& trials, const std::vector<InverseDynamics>& inverse,
                          const std::vector<Member>& with, const std::vector<Member>& without,
                          double slower) {
  std::vector<std::array<double, 2>> blocks;  // Σ residual · force, Σ force²
  double rows = 0;
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const Trial& trial = trials.list[t];
    const std::vector<double> left = residual_with(trial, inverse[t], with, slower),
                              before = residual_with(trial, inverse[t], without, slower);
    const size_t block =
        std::max<size_t>(1, whole_count(criteria::independent_block_s / inverse[t].motion.sample_time));
    for (size_t k = 0; k < std::min(trial.held_out_from, left.size()); ++k) {
      if (k % block == 0) blocks.push_back({});
      if (!inverse[t].motion.counts[k]) continue;
      const double force = before[k] - left[k];
      blocks.back()[0] += before[k] * force, blocks.back()[1] += force * force, rows += 1;
    }
  }
  double by_force = 0, squares = 0, scatter = 0;
  for (const auto& [product, square] : blocks) by_force += product, squares += square;
  if (squares <= 0) return {};
  const double slope = by_force / squares;
  for (const auto& [product, square] : blocks) scatter += std::pow(product - slope * square, 2);
  return {slope, std::sqrt(scatter) / squares, std::sqrt(squares / rows)};
}

bool is_held_out(const Trials& trials, const std::vector<InverseDynamics>& inverse,
                 const std::vector<Member>& members, size_t member) {
  constexpr double least_share = 1e-3;  // of its force; less is what the filter spreads
  const std::vector<Member> others = without_one(members, member);
  double square[2] = {}, rows[2] = {};  // fitted, held out
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const std::vector<double> with = residual_with(trials.list[t], inverse[t], members),
                              without = residual_with(trials.list[t], inverse[t], others);
    for (size_t k = 0; k < with.size(); ++k) {
      const int side = k >= trials.list[t].held_out_from;
      square[side] += std::pow(without[k] - with[k], 2), rows[side] += 1;
    }
  }
  return rows[1] > 0 && square[1] * rows[0] > least_share * least_share * square[0] * rows[1];
}

namespace {

ForceShare slow_share(const Trials& trials, const std::vector<Member>& members, size_t member) {
  return share_of_force(trials, *trials.inverse, members, without_one(members, member),
                        criteria::slower_balance);
}

}  // namespace

bool is_late_in_slow_balance(const Trials& trials, const std::vector<Member>& members, size_t member) {
  if (!trials.inverse || !is_late_input(*members[member].candidate)) return false;
  const ForceShare share = slow_share(trials, members, member);
  return share.found - criteria::sure_deviations * share.deviation > criteria::least_force_share;
}

bool is_feigned_by_noise(const Trials& trials, const std::vector<Member>& members, size_t member) {
  if (!trials.inverse || !is_late_input(*members[member].candidate)) return false;
  const ForceShare share = slow_share(trials, members, member);
  const bool can_tell = criteria::sure_deviations * share.deviation < criteria::least_force_share;
  return can_tell && share.found < criteria::least_force_share;
}

bool spoils_balance(const Trials& trials, const Estimate& estimate, size_t member, const Weight& weight) {
  if (!trials.inverse) return false;
  const Candidate& candidate = *estimate.members[member].candidate;
  if (candidate.flies) return false;
  const bool is_loud = weight.wald > criteria::loud_wald_per_row * double(fitted_numbers(trials));
  if (is_loud && candidate.acts == Acts::force &&
      weight.force_rms < criteria::noise_that_drives * residual_floor(trials, estimate))
    return false;
  if (is_loud && candidate.acts == Acts::input && weight.force_rms < residual_of_sensor(trials, estimate))
    return false;
  const ForceShare share =
      share_of_force(trials, *trials.inverse, estimate.members, without_one(estimate.members, member));
  const bool is_seen = share.force > criteria::least_seen_of_load * weight.force_rms;
  const double most_found = share.found + criteria::sure_deviations * share.deviation;
  const bool is_opposed =
      !is_loud && most_found < 0 && share.force > criteria::least_opposed_of_load * weight.force_rms;
  if (!is_seen && !is_opposed && is_own_load(estimate.members[member])) return false;
  return most_found < criteria::least_force_share &&
         !is_late_in_slow_balance(trials, estimate.members, member);
}

bool is_negligible(const Trials& trials, const std::vector<Member>& members) {
  if (!trials.inverse) return false;
  const ResidualSize left = residual_size(trials, *trials.inverse, members);
  return std::max(left.fitted, left.held_out) <= criteria::negligible_force * trials.usual_force;
}

namespace {

/// Mean square of the residual that noise alone leaves along a record of an axis with this mass.
double square_of_noise(const AxisModel& model, double mass, const Noise& noise) {
  const double T = model.record().sample_time;
  const bool from_position = model.record().measured.front().role == "position";
  const double motion_cutoff = std::min(200.0, 0.2 / T);
  constexpr int points = 2000;
  double sum = 0;
  for (int i = 0; i < points; ++i) {
    const double f = (i + 0.5) / points * 0.5 / T, w = 2 * std::numbers::pi * f * T;
    const double hold = 0.5 * (1 + std::cos(w));  // the mean of before and after
    const double slow = noise.step * noise.step / std::norm(1.0 - noise.memory * std::polar(1.0, -w));
    const double sensor = from_position ? (2 - 2 * std::cos(w)) / (T * T) : std::sin(w) / T;
    const double motion = gain_of_filter(f, motion_cutoff, T) * sensor * mass * noise.measurement[0];
    const double filter = gain_of_filter(f, force_cutoff(T), T);
    sum += filter * filter * (hold * (noise.white * noise.white + slow) + motion * motion);
  }
  return sum / points;
}

}  // namespace

double residual_of_sensor(const Trials& trials, Estimate estimate) {
  estimate.noise.white = estimate.noise.step = 0;
  return residual_floor(trials, estimate);
}

double residual_floor(const Trials& trials, const Estimate& estimate) {
  const double added = added_inertia(estimate.members);
  double sum = 0, rows = 0;
  for (const Trial& trial : trials.list) {
    const AxisModel& model = *trial.model;
    const double own = double(model.record().rows()), nominal = model.nominal_inertia(),
                 mass = nominal + added;
    sum += own * square_of_noise(model, mass, estimate.noise.at_inertia(mass / nominal)), rows += own;
  }
  return std::sqrt(sum / rows);
}

}  // namespace loopwright::diagnosis
