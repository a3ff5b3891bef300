#include "tools/sweep/design.h"
#include <algorithm>
#include <bit>
#include <boost/random/sobol.hpp>
#include <cmath>
#include "models/random/normal_quantile.h"
#include "models/random/philox.h"
#include "models/real/double_functions.h"

namespace loopwright {
namespace {

/// Random streams of the sweep's seed.
enum Stream : uint64_t { random_samples = 0, strata = 1 << 16, within_stratum = 2 << 16, shifts = 3 << 16 };

/// (0, 1), both ends excluded.
double open_uniform(uint64_t bits) { return double((bits >> 12) << 1 | 1) * 0x1p-53; }

/// A permutation of 0 … n - 1 without a table: four Feistel rounds on the next even number of bits, repeated
/// until the result lies below n. Source: Black & Rogaway, Ciphers with arbitrary finite domains, 2002.
uint64_t permuted(uint64_t i, uint64_t n, uint64_t seed, uint64_t stream) {
  const int half = std::max(1, (int(std::bit_width(n - 1)) + 1) / 2);
  const uint64_t mask = (uint64_t(1) << half) - 1;
  do {
    uint64_t left = i >> half, right = i & mask;
    for (uint32_t round = 0; round < 4; ++round) {
      const auto word =
          philox({uint32_t(right), round, uint32_t(stream), 0}, {uint32_t(seed), uint32_t(seed >> 32)});
      const uint64_t next = left ^ (word[0] & mask);
      left = right, right = next;
    }
    i = left << half | right;
  } while (i >= n);
  return i;
}

}  // namespace

SweepDesign::SweepDesign(const Sweep& sweep, std::vector<bool> changes_plan) : sweep_(sweep) {
  for (const bool slow : {true, false})
    for (size_t a = 0; a < sweep.axes.size(); ++a) {
      const Axis& axis = sweep.axes[a];
      if (axis.is_sampled() || axis.pair >= 0) continue;
      bool changes = changes_plan[a];
      for (size_t b = a + 1; b < sweep.axes.size(); ++b)
        changes |= sweep.axes[b].pair == int(a) && changes_plan[b];
      if (changes != slow) continue;
      digits_.push_back(a);
      (slow ? worlds_ : grid_) *= int64_t(axis.count());
    }
  for (size_t a = 0; a < sweep.axes.size(); ++a)
    if (sweep.axes[a].is_sampled()) sampled_.push_back(a);
  if (sampled_.empty()) return;
  samples_ = sweep.samples.count;
  if (sweep.samples.method == Sampling::saltelli) samples_ *= int64_t(sampled_.size()) + 2;
}

std::vector<double> SweepDesign::point(int64_t run) const {
  std::vector<double> values(sweep_.axes.size());
  std::vector<size_t> index(sweep_.axes.size());
  const int64_t sample = run % samples_;
  int64_t rest = run / samples_;
  for (size_t d = digits_.size(); d-- > 0;) {
    const int64_t count = int64_t(sweep_.axes[digits_[d]].count());
    index[digits_[d]] = size_t(rest % count);
    rest /= count;
  }
  for (size_t a = 0; a < values.size(); ++a) {
    const Axis& axis = sweep_.axes[a];
    if (axis.is_sampled()) continue;
    const size_t i = index[axis.pair >= 0 ? size_t(axis.pair) : a];
    values[a] = axis.kind == Axis::Kind::variants ? double(i) : axis.values[i];
  }
  if (sampled_.empty()) return values;
  const bool is_sobol = sweep_.samples.method >= Sampling::sobol;
  const std::vector<double> u = is_sobol ? sobol(sample) : std::vector<double>();
  for (size_t i = 0; i < sampled_.size(); ++i)
    values[sampled_[i]] = quantile(sweep_.axes[sampled_[i]], is_sobol ? u[i] : uniform(sample, i));
  return values;
}

double SweepDesign::uniform(int64_t sample, size_t rank) const {
  const uint64_t seed = sweep_.seed, n = uint64_t(samples_), s = uint64_t(sample);
  if (sweep_.samples.method == Sampling::random)
    return uniform_pair(seed, Stream::random_samples + rank, s).first;
  const double stratum = double(permuted(s, n, seed, Stream::strata + rank));
  return (stratum + uniform_pair(seed, Stream::within_stratum + rank, s).first) / double(n);
}

/// Sobol's points without the origin, each digit shifted at random: still a net, but a different one for each
/// seed. For Saltelli's design the first half of the columns is A, the other B; block k of the samples is A,
/// B, or A with one column of B. Source: A. Saltelli et al., Comput. Phys. Commun. 181 (2010) 259.
std::vector<double> SweepDesign::sobol(int64_t sample) const {
  const bool is_saltelli = sweep_.samples.method == Sampling::saltelli;
  const size_t axes = sampled_.size(), columns = is_saltelli ? 2 * axes : axes;
  const int64_t block = is_saltelli ? sample / sweep_.samples.count : 0;
  // Computing the direction numbers takes far longer than computing a point.
  thread_local std::unique_ptr<boost::random::sobol> sequence;
  if (!sequence || sequence->dimension() != columns)
    sequence = std::make_unique<boost::random::sobol>(columns);
  sequence->seed(uint64_t(is_saltelli ? sample % sweep_.samples.count : sample));
  std::vector<double> all(columns);
  for (size_t c = 0; c < columns; ++c) {
    const auto word = philox({uint32_t(c), 0, uint32_t(Stream::shifts), 0},
                             {uint32_t(sweep_.seed), uint32_t(sweep_.seed >> 32)});
    all[c] = open_uniform((*sequence)() ^ (uint64_t(word[0]) << 32 | word[1]));
  }
  std::vector<double> u(axes);
  for (size_t a = 0; a < axes; ++a) {
    const bool from_second = block == 1 || block == int64_t(a) + 2;
    u[a] = all[from_second ? axes + a : a];
  }
  return u;
}

double SweepDesign::quantile(const Axis& axis, double u) {
  switch (axis.kind) {
    case Axis::Kind::logarithmic:
      return axis.low * any_power(axis.high / axis.low, u);
    case Axis::Kind::normal:
      return axis.low + axis.high * normal_quantile(u);
    default:
      return axis.low + (axis.high - axis.low) * u;
  }
}

std::pair<std::vector<double>, std::vector<double>> SweepDesign::range() const {
  auto low = point(0), high = low;
  const int64_t steps = runs();
  for (size_t a = 0; a < low.size(); ++a) {
    const Axis& axis = sweep_.axes[a];
    if (axis.is_sampled() || axis.kind == Axis::Kind::variants) continue;
    low[a] = *std::min_element(axis.values.begin(), axis.values.end());
    high[a] = *std::max_element(axis.values.begin(), axis.values.end());
  }
  if (sampled_.empty()) return {low, high};
  for (int64_t run = 0; run < std::min(steps, samples_); ++run) {
    const auto values = point(run);
    for (const size_t a : sampled_)
      low[a] = std::min(low[a], values[a]), high[a] = std::max(high[a], values[a]);
  }
  return {low, high};
}

}  // namespace loopwright
