/// The amplitudes of the frequencies in an evenly sampled signal.
#pragma once
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

namespace loopwright {

struct AmplitudeSpectrum {
  std::vector<double> frequency;  ///< Hz, rising from the first above zero to half of the sampling rate
  std::vector<double> amplitude;  ///< in the unit of the signal: A of A·sin(2π f t) at its frequency
};

/// In place, for a power of two of values: X[k] = Σ x[n] exp(-2πi k n/N).
inline void fourier_transform(std::vector<std::complex<double>>& x) {
  const size_t n = x.size();
  for (size_t i = 1, j = 0; i < n; ++i) {
    size_t bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  for (size_t length = 2; length <= n; length <<= 1) {
    const double angle = -2 * std::numbers::pi / double(length);
    for (size_t k = 0; k < length / 2; ++k) {
      const std::complex<double> turn(std::cos(angle * double(k)), std::sin(angle * double(k)));
      for (size_t i = k; i < n; i += length) {
        const std::complex<double> odd = turn * x[i + length / 2];
        x[i + length / 2] = x[i] - odd;
        x[i] += odd;
      }
    }
  }
}

/// `values`, `step` seconds apart, without their mean and under a Hann window; zeros fill up to a power of
/// two. Fewer than 8 values have no spectrum.
inline AmplitudeSpectrum amplitude_spectrum(const std::vector<double>& values, double step) {
  AmplitudeSpectrum spectrum;
  const size_t count = values.size();
  if (count < 8 || !(step > 0)) return spectrum;
  double mean = 0;
  for (const double value : values) mean += value / double(count);
  size_t length = 1;
  while (length < count) length <<= 1;
  std::vector<std::complex<double>> x(length);
  double weight = 0;
  for (size_t i = 0; i < count; ++i) {
    const double window = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * double(i) / double(count));
    x[i] = window * (values[i] - mean);
    weight += window;
  }
  fourier_transform(x);
  for (size_t k = 1; k <= length / 2; ++k) {
    spectrum.frequency.push_back(double(k) / (double(length) * step));
    spectrum.amplitude.push_back((k == length / 2 ? 1 : 2) * std::abs(x[k]) / weight);
  }
  return spectrum;
}

}  // namespace loopwright
