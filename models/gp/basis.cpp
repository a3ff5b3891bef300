#include "models/gp/basis.h"
#include "models/real/whole.h"
#include <algorithm>
#include <cmath>
#include <numbers>
#include "models/real/functions.h"

namespace loopwright::gp {
namespace {

using std::numbers::pi;

constexpr int most_terms = 1 << 20;  // terms of a series: enough for lengths of 1e-5 periods

/// I_j(z)/I_{j-1}(z) for j = 1 … count, by the continued fraction started at a large order: stable, never
/// overflows.
std::vector<double> bessel_ratios(double z, int count) {
  std::vector<double> ratio(size_t(count) + 1, 0.0);
  double next = 0;
  for (int j = count + 30; j >= 1; --j) {
    next = 1 / (2 * j / z + next);
    if (j <= count) ratio[size_t(j)] = next;
  }
  return ratio;
}

/// e^(-z) I_j(z), j = 0 … count.
std::vector<double> scaled_bessel(double z, int count) {
  const int enough = count + whole_between(std::sqrt(80 * z), 0, most_terms) + 20;  // orders summed below
  const std::vector<double> ratio = bessel_ratios(z, enough);
  double sum = 0, product = 1;
  for (int j = 1; j <= enough; ++j) sum += product *= ratio[size_t(j)];
  std::vector<double> value{1 / (1 + 2 * sum)};  // I₀ + 2 Σ I_j = e^z
  for (int j = 1; j <= count; ++j) value.push_back(value.back() * ratio[size_t(j)]);
  return value;
}

}  // namespace

int size_for(const Basis& basis, double length) {
  if (basis.kind == Basis::Kind::fourier) {
    const double z = 1 / (length * length);
    const int most = whole_between(std::sqrt(80 * z), 0, most_terms) + 25;
    const std::vector<double> ratio = bessel_ratios(z, most);
    double weight = 1;
    int j = 0;
    while (j < most && weight > 1e-17) weight *= ratio[size_t(++j)];
    return 2 * j + 1;
  }
  if (basis.kind == Basis::Kind::chebyshev) {
    // The spectrum of exp(-r²/(2ℓ²)) has fallen to 1e-15 at 8.3/ℓ. T_n resolves n rad on half the interval.
    const double needed = 8.3 * 0.5 * (basis.high - basis.low) / length + 14;
    return whole_between(std::ceil(needed / 4), 1, most_terms / 4) * 4;
  }
  return basis.size;
}

Basis cut(const Basis& basis, double length) {
  Basis smaller = basis;
  smaller.size = std::min(basis.size, size_for(basis, length));
  return smaller;
}

std::vector<double> nodes_of(const Basis& basis) {
  if (basis.kind == Basis::Kind::levels) return basis.levels;
  std::vector<double> nodes;
  const double middle = 0.5 * (basis.low + basis.high), half = 0.5 * (basis.high - basis.low);
  for (int a = 0; a < basis.size; ++a) nodes.push_back(middle + half * cosine(pi * (a + 0.5) / basis.size));
  return nodes;
}

PeriodicWeights periodic_weights(double length, int size) {
  const double z = 1 / (length * length);
  const int harmonics = (size - 1) / 2;
  const std::vector<double> bessel = scaled_bessel(z, harmonics + 1);
  PeriodicWeights weights;
  for (int j = 0; j <= harmonics; ++j) {
    // d/dz e^(-z) I_j = e^(-z) ((I_{j-1} + I_{j+1})/2 - I_j), and dz/d(log ℓ) = -2z
    const double before = bessel[size_t(std::abs(j - 1))], here = bessel[size_t(j)],
                 after = bessel[size_t(j + 1)];
    const double slope = -2 * z * (0.5 * (before + after) - here);
    for (int twin = 0; twin < (j == 0 ? 1 : 2); ++twin) {
      weights.value.push_back(j == 0 ? here : 2 * here);
      weights.slope.push_back(j == 0 ? slope : 2 * slope);
    }
  }
  return weights;
}

int moment_count(const Basis& basis) {
  switch (basis.kind) {
    case Basis::Kind::constant:
      return 1;
    case Basis::Kind::levels:
      return basis.size + 1;
    default:
      return 2 * basis.size - 1;
  }
}

void moment_functions(const Basis& basis, std::span<const double> values, int count, double* out) {
  const size_t n = values.size();
  const auto row = [&](int function) { return out + size_t(function) * n; };
  std::fill_n(out, n * size_t(count), 0.0);
  if (basis.kind == Basis::Kind::levels) {
    for (size_t i = 0; i < n; ++i) {
      const auto level = std::ranges::lower_bound(basis.levels, values[i]) - basis.levels.begin();
      row(int(level))[i] = 1;
      if (count > basis.size) row(basis.size)[i] = 1;
    }
    return;
  }
  std::fill_n(out, n, 1.0);
  if (count == 1) return;
  if (basis.kind == Basis::Kind::chebyshev) {
    const double middle = 0.5 * (basis.low + basis.high), half = 0.5 * (basis.high - basis.low);
    for (size_t i = 0; i < n; ++i) row(1)[i] = (values[i] - middle) / half;
    for (int k = 2; k < count; ++k)
      for (size_t i = 0; i < n; ++i) row(k)[i] = 2 * row(1)[i] * row(k - 1)[i] - row(k - 2)[i];
    return;
  }
  for (size_t i = 0; i < n; ++i) {
    const double turns = values[i] / basis.period;
    const double angle = 2 * pi * (turns - std::nearbyint(turns));
    row(1)[i] = cosine(angle);
    if (count > 2) row(2)[i] = sine(angle);
  }
  for (int k = 3; k + 1 < count; k += 2) {
    double *cosine = row(k), *sine = row(k + 1);
    const double *c = row(k - 2), *s = row(k - 1), *c1 = row(1), *s1 = row(2);
    for (size_t i = 0; i < n; ++i) {
      cosine[i] = c[i] * c1[i] - s[i] * s1[i];
      sine[i] = s[i] * c1[i] + c[i] * s1[i];
    }
  }
}

namespace {

/// Adds cos or sin of harmonic |j| as a moment, with the sign of the sine.
void add(Pairing& pairing, bool is_sine, int harmonic, double weight) {
  if (is_sine && harmonic == 0) return;
  const int j = std::abs(harmonic);
  pairing.moment[pairing.count] = j == 0 ? 0 : 2 * j - (is_sine ? 0 : 1);
  pairing.weight[pairing.count++] = is_sine && harmonic < 0 ? -weight : weight;
}

Pairing fourier_pairing(int a, int b) {
  const int j = (a + 1) / 2, k = (b + 1) / 2;
  const bool a_is_sine = a > 0 && a % 2 == 0, b_is_sine = b > 0 && b % 2 == 0;
  Pairing pairing;
  if (a_is_sine == b_is_sine) {  // cos cos = (cos(j-k) + cos(j+k))/2, sin sin = (cos(j-k) - cos(j+k))/2
    add(pairing, false, j - k, 0.5);
    add(pairing, false, j + k, a_is_sine ? -0.5 : 0.5);
  } else {  // sin j cos k = (sin(j+k) + sin(j-k))/2
    add(pairing, true, j + k, 0.5);
    add(pairing, true, a_is_sine ? j - k : k - j, 0.5);
  }
  return pairing;
}

}  // namespace

Pairing pairing(const Basis& basis, int a, int b) {
  switch (basis.kind) {
    case Basis::Kind::constant:
      return {1, {0, 0}, {1, 0}};
    case Basis::Kind::fourier:
      return fourier_pairing(std::max(a, 0), std::max(b, 0));
    case Basis::Kind::chebyshev: {
      const int j = std::max(a, 0), k = std::max(b, 0);
      return {2, {std::abs(j - k), j + k}, {0.5, 0.5}};
    }
    case Basis::Kind::levels:
      if (a >= 0 && b >= 0 && a != b) return {};
      return {1, {a < 0 && b < 0 ? basis.size : std::max(a, b), 0}, {1, 0}};
  }
  return {};
}

}  // namespace loopwright::gp
