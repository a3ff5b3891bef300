#include "models/linear/frequency_response.h"
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include "models/linear/decompositions.h"
#include "models/linear/poles.h"

namespace loopwright {

using Eigen::Index;
using Eigen::MatrixXcd;
using Complex = std::complex<double>;

namespace {
double largest_entry(const Eigen::MatrixXd& A) { return A.size() ? A.cwiseAbs().maxCoeff() : 0.0; }
}  // namespace

FrequencyResponse::FrequencyResponse(const StateSpace& system, int lifted)
    : system_(balanced(system)), lifted_(lifted) {
  if (system.states() == 0) return;
  const auto [T, U] = triangularised(system_.A);
  T_ = T, B_ = U.adjoint() * system_.B, C_ = system_.C * U;
}

double FrequencyResponse::nyquist() const {
  return system_.sample_time > 0 ? std::numbers::pi * lifted_ / system_.sample_time
                                 : std::numeric_limits<double>::infinity();
}

MatrixXcd FrequencyResponse::transfer(Complex point) const {
  if (system_.states() == 0) return system_.D.cast<Complex>();
  MatrixXcd pencil = -T_;
  pencil.diagonal().array() += point;
  return C_ * pencil.triangularView<Eigen::Upper>().solve(B_) + system_.D;
}

MatrixXcd FrequencyResponse::at(double frequency) const {
  const Complex turn(0, frequency * system_.sample_time);
  const MatrixXcd all = transfer(system_.sample_time > 0 ? std::exp(turn) : Complex(0, frequency));
  const Index inputs = system_.inputs(), outputs = system_.outputs();
  if (lifted_ > 1) {
    const Index m = inputs / lifted_, p = outputs / lifted_;
    MatrixXcd share = MatrixXcd::Zero(p, m);
    for (int out = 0; out < lifted_; ++out)
      for (int in = 0; in < lifted_; ++in)
        share += std::exp(turn * double(in - out) / double(lifted_)) * all.block(out * p, in * m, p, m);
    return share / double(lifted_);
  }
  const Index delays = Index(system_.delays.size());
  if (delays == 0) return all;
  MatrixXcd lag = MatrixXcd::Zero(delays, delays);
  for (Index i = 0; i < delays; ++i) lag(i, i) = std::exp(Complex(0, -frequency * system_.delays[size_t(i)]));
  const MatrixXcd around = MatrixXcd::Identity(delays, delays) - lag * all.bottomRightCorner(delays, delays);
  return all.topLeftCorner(outputs, inputs) +
         all.topRightCorner(outputs, delays) *
             around.partialPivLu().solve(lag * all.bottomLeftCorner(delays, inputs));
}

std::vector<double> interesting_frequencies(const StateSpace& system, int count, int lifted) {
  const bool is_sampled = system.sample_time > 0;
  double nyquist = std::numeric_limits<double>::infinity();
  if (is_sampled) nyquist = std::numbers::pi * lifted / system.sample_time;
  const std::vector<Pole> all = poles(system);
  double slowest = std::numeric_limits<double>::infinity(), fastest = 0;
  std::vector<double> frequencies;
  const auto is_seen = [&](const Pole& pole) {
    return pole.frequency < nyquist && std::isfinite(pole.frequency);
  };
  // The poles of integrators are at 0 except for rounding. Several integrators in series give a root of the
  // rounding error. Their loop crosses over above it.
  const double rounding =
      1e-5 * (is_sampled ? lifted / system.sample_time : largest_entry(balanced(system).A));
  for (const Pole& pole : all)
    if (is_seen(pole) && pole.frequency > rounding) fastest = std::max(fastest, pole.frequency);
  for (const Pole& pole : all) {
    if (!is_seen(pole)) continue;
    const bool integrates = pole.frequency <= rounding;
    slowest = std::min(slowest, integrates ? 1e-3 * fastest : pole.frequency);
    if (integrates || pole.damping > 0.3 || pole.value.imag() <= 0) continue;
    const double width = std::max(std::abs(pole.damping), 1e-6);
    for (int i = -20; i <= 20; ++i)
      frequencies.push_back(pole.frequency * (1 + width * std::pow(i / 8.0, 3)));
  }
  if (!(fastest > 0)) fastest = is_sampled ? nyquist / 10 : 100, slowest = 1e-3 * fastest;
  for (double delay : system.delays) fastest = std::max(fastest, 10 / delay);
  const double low = slowest / 10, high = is_sampled ? nyquist : fastest * 10;
  for (int i = 0; i < count; ++i) frequencies.push_back(low * std::pow(high / low, double(i) / (count - 1)));
  std::erase_if(frequencies, [&](double f) { return !(f > 0) || f > high; });
  std::ranges::sort(frequencies);
  return frequencies;
}

}  // namespace loopwright
