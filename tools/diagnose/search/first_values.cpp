#include "tools/diagnose/search/first_values.h"
#include <algorithm>
#include <cmath>
#include "models/statistics/quantile.h"

namespace loopwright::diagnosis::first_values {
namespace {

double largest(std::span<const double> signal) {
  double size = 0;
  for (double s : signal) size = std::max(size, std::abs(s));
  return size;
}
double root_mean_square(std::span<const double> signal) {
  double square = 0;
  for (double s : signal) square += s * s;
  return std::sqrt(square / double(std::max<size_t>(1, signal.size())));
}
/// Of displacements, from the velocity: how far it goes from its mean path, in samples.
double displacement(std::span<const double> velocity) {
  double place = 0, sum = 0, square = 0;
  for (double v : velocity) place += v, sum += place, square += place * place;
  const double count = double(std::max<size_t>(1, velocity.size())), mean = sum / count;
  return std::sqrt(std::max(0.0, square / count - mean * mean));
}

}  // namespace

Starts widths(std::span<const double> signal) {
  const double size = root_mean_square(signal);
  return {{0.003 * size, 0}, {0.03 * size, 0}};
}
/// As close as a fit of few steps reaches: a limit at half the largest value gained nothing visible from 0.4
/// or 0.8 of it.
Starts knees(std::span<const double> signal) {
  Starts list;
  const double size = largest(signal);
  for (double part : {0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9})
    list.push_back({part * size, 0});
  return list;
}
Starts stribeck_speeds(std::span<const double> signal) {
  Starts list;
  const double size = root_mean_square(signal);
  for (double part : {0.05, 0.15, 0.5}) list.push_back({0.003 * size, part * size});
  return list;
}
/// Levels that the signal exceeds for a part of the record.
Starts levels(std::span<const double> signal) {
  Starts list;
  for (double part : {0.1, 0.25, 0.4, 0.55, 0.7, 0.8, 0.88, 0.94, 0.97})
    list.push_back({lower_quantile(signal, part), 0});
  return list;
}
/// Of which the signal falls short for a part of the record.
Starts levels_above(std::span<const double> signal) {
  Starts list;
  for (double part : {0.03, 0.06, 0.12, 0.2, 0.3, 0.45, 0.6, 0.75, 0.9})
    list.push_back({lower_quantile(signal, part), 0});
  return list;
}
/// From two periods in the range of the signal up; neighbours differ by a quarter of a period at the end of
/// the range.
Starts pitches(std::span<const double> signal) {
  constexpr double fewest = 1.5, most = 80, step = 0.25;  // periods in the range
  const auto [low, high] = std::ranges::minmax(signal);
  Starts list;
  for (double periods = fewest; periods <= most; periods += step) list.push_back({(high - low) / periods, 0});
  return list;
}

/// In samples, and the input before: as it is at first, or none.
Starts waits(std::span<const double> input) {
  Starts list;
  for (double samples : {0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0})
    for (double before : {input.front(), 0.0}) list.push_back({samples, before});
  return list;
}

Starts distances(std::span<const double> velocity) {
  Starts list;
  for (double part : {0.03, 0.1, 0.3, 1.0, 3.0, 10.0}) list.push_back({part * displacement(velocity), 0});
  return list;
}
/// Over a much longer distance it is a spring.
TermShape::Ranges ranges_of_distance(std::span<const double> velocity) {
  const double size = displacement(velocity);
  return {{2e-3 * size, 0}, {30 * size, 0}};
}

}  // namespace loopwright::diagnosis::first_values
