#include "tools/diagnose/search/spectrum.h"
#include "tools/diagnose/search/adjoint.h"
#include "tools/diagnose/search/backward.h"
#include "tools/diagnose/search/unknown.h"
#include "models/real/whole.h"
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace loopwright::diagnosis {
namespace {

using Complex = std::complex<double>;

/// |z / φ| of the error filter at a frequency [rad/sample].
double gain_at(const ErrorSystem& system, const Gains& gains, bool is_sensor, double w) {
  const Eigen::Index n = system.enter.size();
  const Eigen::MatrixXcd I = Eigen::MatrixXcd::Identity(n, n);
  const Eigen::MatrixXd closed =
      system.onward * (Eigen::MatrixXd::Identity(n, n) - system.correct * system.C);
  const Eigen::VectorXd drive =
      is_sensor ? Eigen::VectorXd(-system.onward * system.correct.col(0)) : Eigen::VectorXd(-system.enter);
  const Eigen::VectorXcd x =
      (std::polar(1.0, w) * I - closed.cast<Complex>()).partialPivLu().solve(drive.cast<Complex>());
  Eigen::VectorXcd e = system.C.cast<Complex>() * x;
  if (is_sensor) e[0] += 1.0;
  return (gains.whiten.cast<Complex>() * e).norm();
}

/// A uniform grid of spatial frequencies: k / (samples · bin), k = 0 … samples / 2.
struct SpatialGrid {
  static constexpr size_t most_bins = 1 << 24;  // finer than any record resolves
  double low, shortest, bin;
  size_t bins, samples;

  SpatialGrid(double lowest, double highest, double shortest_pitch)
      : low(lowest), shortest(shortest_pitch), bin(shortest_pitch / 6) {
    bins = whole_between<size_t>((highest - lowest) / bin, 0, most_bins) + 1;
    samples = 1;
    while (samples < 4 * bins) samples *= 2;
  }
  double frequency(size_t k) const { return double(k) / (double(samples) * bin); }
  /// Whether its pitch is at least the shortest one.
  bool resolves(size_t k) const { return 1 / frequency(k) >= shortest; }
  size_t place(double position) const { return whole_index((position - low) / bin, bins); }
};

/// How an effect of unit amplitude rises and decays when it does not repeat: the limit of infinite pitch.
Column::Numbers envelope(const Candidate& candidate, const Path& path, double stroke) {
  std::vector<double> shape;
  for (const CandidateParameter& p : candidate.nonlinear) shape.push_back(p.grid[p.grid.size() / 2]);
  shape[0] = 1e9 * stroke;
  Columns columns = candidate.columns(path, shape);
  const auto size = [](const Column& c) {
    double sum = 0;
    for (float v : *c.mean) sum += double(v) * double(v);
    return sum;
  };
  return std::ranges::max_element(columns, {}, size)->mean;
}

/// Of every record.
using Weights = std::vector<std::vector<double>>;

/// Explained squares at every spatial frequency whose pitch may be asked for, over all records; beyond them
/// 0.
std::vector<double> spectrum(const Trials& trials, const Estimate& estimate, const Candidate& candidate,
                             const Weights& weights, const SpatialGrid& grid, double stroke) {
  std::vector<Complex> density(grid.samples);
  constexpr size_t speeds = 64;
  std::vector<double> by_speed(speeds, 0.0);
  double top = candidate.repeats_in_time ? 1 : 0;
  for (const Fitted& fitted : *estimate.fitted)
    for (double v : fitted.prediction.path.velocity)
      if (!candidate.repeats_in_time) top = std::max(top, std::abs(v));
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const Path& path = *estimate.motion.paths[t];
    const std::vector<double>& weight = weights[t];
    const Column::Numbers envelope_now = envelope(candidate, path, stroke);
    const std::vector<float>& swell = *envelope_now;
    const double T = path.sample_time;
    const std::vector<double> time = candidate.repeats_in_time ? times_of(path) : std::vector<double>();
    const auto coordinate = [&](size_t k) {
      if (candidate.repeats_in_time) return 0.5 * (time[k] + time[k + 1]);
      return path.predicted_position[k] + (candidate.acts == Acts::sensor ? 0 : 0.5 * T * path.velocity[k]);
    };
    for (size_t k = 0; k < std::min(path.samples(), trials.list[t].held_out_from); ++k) {
      density[grid.place(coordinate(k))] += weight[k] * double(swell[k]);
      const double rate = candidate.repeats_in_time ? top : std::abs(path.velocity[k]);
      if (trials.list[t].usable[k])
        by_speed[whole_index(rate / top * speeds, speeds)] += double(swell[k]) * double(swell[k]);
    }
  }
  std::vector<Complex> lines;
  Eigen::FFT<double>().fwd(lines, density);
  // The filter's gain at the frequency of a pitch at a speed, from a table.
  const Fitted& fitted = estimate.fitted->front();
  const ErrorSystem system(fitted, candidate.acts == Acts::input);
  constexpr size_t table_size = 400;
  std::vector<double> table;
  for (size_t i = 0; i <= table_size; ++i)
    table.push_back(std::pow(gain_at(system, fitted.gains, candidate.acts == Acts::sensor,
                                     std::max(1e-4, std::numbers::pi * double(i) / table_size)),
                             2));
  const double T = fitted.prediction.path.sample_time;
  std::vector<double> explained(grid.samples / 2);
  for (size_t f = 0; f < explained.size() && grid.resolves(f); ++f) {
    double energy = 0;
    for (size_t s = 0; s < speeds; ++s) {
      const double per_sample =
          2 * grid.frequency(f) * top * (double(s) + 0.5) / speeds * T;  // 1: half the rate
      if (per_sample < 1) energy += by_speed[s] * table[whole_index(per_sample * table_size, table.size())];
    }
    explained[f] = energy > 0 ? 2 * std::norm(lines[f]) / energy : 0;
  }
  return explained;
}

/// The highest peaks within the range, separated by more than the resolution of the stroke.
std::vector<double> peaks(const std::vector<double>& explained, const SpatialGrid& grid, double low,
                          double high, size_t count) {
  std::vector<double> pitches;
  std::vector<double> left = explained;
  left[0] = 0;  // of no pitch
  const size_t apart = grid.samples / grid.bins + 1;
  for (size_t i = 0; i < count; ++i) {
    size_t best = 0;
    for (size_t f = 1; f < left.size(); ++f) {
      const double pitch = 1 / grid.frequency(f);
      if (pitch >= low && pitch <= high && left[f] > left[best]) best = f;
    }
    if (best == 0) break;
    pitches.push_back(1 / grid.frequency(best));
    for (size_t f = best > apart ? best - apart : 0; f < std::min(left.size(), best + apart + 1); ++f)
      left[f] = 0;
  }
  return pitches;
}

}  // namespace

std::vector<Shape> periodic_shapes(const Trials& trials, const Estimate& estimate,
                                   const std::vector<Candidate>& candidates, size_t lines) {
  const double lowest = trials.lowest_position, highest = trials.highest_position, stroke = highest - lowest;
  std::vector<Shape> shapes;
  if (!(stroke > 0)) return shapes;
  std::map<Acts, Weights> weights;
  for (const Candidate& candidate : candidates) {
    if (!candidate.is_periodic) continue;
    const double low = candidate.nonlinear[0].low, high = candidate.nonlinear[0].high;
    const SpatialGrid grid =
        candidate.repeats_in_time ? SpatialGrid(0, trials.longest_s, low) : SpatialGrid(lowest, highest, low);
    Weights& weight = weights[candidate.acts];
    for (size_t t = weight.size(); t < trials.list.size(); ++t)
      weight.push_back(adjoint(trials.list[t], (*estimate.fitted)[t], candidate.acts));
    const std::vector<double> explained = spectrum(trials, estimate, candidate, weight, grid, stroke);
    const double fine = std::clamp(candidate.fine_pitch, low, high);
    std::vector<double> pitches = peaks(explained, grid, fine, high, lines);
    if (fine > low) std::ranges::copy(peaks(explained, grid, low, fine, 1), std::back_inserter(pitches));
    for (const Member& member : estimate.members)
      if (member.candidate->is_periodic && !candidate.repeats_in_time && !member.candidate->repeats_in_time &&
          member.candidate != &candidate && member.nonlinear[0] > low && member.nonlinear[0] < high)
        pitches.push_back(member.nonlinear[0]);
    std::vector<std::vector<double>> points;
    for (double pitch : pitches) {
      std::vector<double>& point = points.emplace_back();
      for (const CandidateParameter& p : candidate.nonlinear) point.push_back(p.grid[p.grid.size() / 2]);
      point[0] = pitch;
    }
    add_shapes(candidate, points, estimate.motion, shapes);
  }
  return shapes;
}

}  // namespace loopwright::diagnosis
