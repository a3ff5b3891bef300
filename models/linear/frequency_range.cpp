#include "models/linear/frequency_range.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include "models/linear/frequency_response.h"
#include "models/linear/margins.h"
#include "models/linear/poles.h"

namespace loopwright {
namespace {

double largest_entry(const Eigen::MatrixXd& A) { return A.size() ? A.cwiseAbs().maxCoeff() : 0.0; }

/// From `edge` on in decades, until |L| cannot cross 1 any more: it is constant, or far from 1 and moves away
/// from it.
template <class Gain> double beyond_crossovers(Gain&& gain, double edge, double decade) {
  constexpr int most_decades = 12;
  constexpr double far = 100, nearly_constant = 0.01;
  double here = gain(edge);
  for (int i = 0; i < most_decades; ++i) {
    const double next = gain(edge * decade);
    const bool is_far = here > far || here<1 / far, leaves = here> 1 ? next >= here : next <= here;
    if (!(std::abs(next - here) > nearly_constant * here) || (is_far && leaves)) break;
    edge *= decade, here = next;
  }
  return edge;
}

class FrequencyRange {
 public:
  FrequencyRange(const StateSpace& system, int lifted)
      : is_sampled_(system.sample_time > 0), period_(system.sample_time / lifted), delays_(system.delays) {
    if (is_sampled_) nyquist_ = std::numbers::pi / period_;
    add_poles(system);
  }

  void add_poles(const StateSpace& system) {
    // The poles of integrators are at 0 except for rounding. Several integrators in series give a root of the
    // rounding error. Their loop crosses over above it.
    const double rounding = 1e-5 * (is_sampled_ ? 1 / period_ : largest_entry(balanced(system).A));
    for (const Pole& pole : poles(system))
      if (pole.frequency < nyquist_ && std::isfinite(pole.frequency))
        seen_.push_back({pole.frequency, pole.damping, pole.value.imag() > 0, pole.frequency <= rounding});
  }

  /// After the last pole was added.
  void find_ends() {
    double slowest = std::numeric_limits<double>::infinity(), fastest = 0;
    for (const Seen& pole : seen_)
      if (!pole.integrates) fastest = std::max(fastest, pole.frequency);
    for (const Seen& pole : seen_)
      slowest = std::min(slowest, pole.integrates ? 1e-3 * fastest : pole.frequency);
    if (!(fastest > 0)) fastest = is_sampled_ ? nyquist_ / 10 : 100, slowest = 1e-3 * fastest;
    for (double delay : delays_) fastest = std::max(fastest, 10 / delay);
    low_ = slowest / 10, high_ = is_sampled_ ? nyquist_ : fastest * 10;
  }

  void reach_crossovers(const FrequencyResponse& response) {
    const auto gain = [&](double frequency) { return std::abs(response.at(frequency)(0, 0)); };
    low_ = beyond_crossovers(gain, low_, 0.1);
    if (!is_sampled_) high_ = beyond_crossovers(gain, high_, 10);
  }

  std::vector<double> spread(int count) const {
    std::vector<double> frequencies;
    for (const Seen& pole : seen_) {
      if (pole.integrates || pole.damping > 0.3 || !pole.is_upper) continue;
      const double width = std::max(std::abs(pole.damping), 1e-6);
      for (int i = -20; i <= 20; ++i)
        frequencies.push_back(pole.frequency * (1 + width * std::pow(i / 8.0, 3)));
    }
    for (int i = 0; i < count; ++i)
      frequencies.push_back(low_ * std::pow(high_ / low_, double(i) / (count - 1)));
    std::erase_if(frequencies, [&](double f) { return !(f > 0) || f > high_; });
    std::ranges::sort(frequencies);
    return frequencies;
  }

 private:
  struct Seen {
    double frequency, damping;
    bool is_upper;    ///< of a pair of poles, the one with the positive imaginary part
    bool integrates;  ///< at 0 except for rounding
  };
  const bool is_sampled_;
  const double period_;  ///< s, between samples
  const std::vector<double> delays_;
  double nyquist_ = std::numeric_limits<double>::infinity(), low_ = 0, high_ = 0;
  std::vector<Seen> seen_;
};

}  // namespace

std::vector<double> interesting_frequencies(const StateSpace& system, int count, int lifted) {
  FrequencyRange range(system, lifted);
  range.find_ends();
  return range.spread(count);
}

std::vector<double> loop_frequencies(const StateSpace& loop_gain, int count, int lifted) {
  FrequencyRange range(loop_gain, lifted);
  range.add_poles(closed_loop(loop_gain));
  range.find_ends();
  range.reach_crossovers(FrequencyResponse(loop_gain, lifted));
  return range.spread(count);
}

}  // namespace loopwright
