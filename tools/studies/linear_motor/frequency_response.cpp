#include "tools/studies/linear_motor/frequency_response.h"
#include <cmath>
#include <numbers>
#include <span>
#include "tools/studies/linear_motor/runs.h"
#include "models/real/whole.h"

namespace loopwright::paper {
namespace {

using Complex = std::complex<double>;
constexpr double sample_time_s = 0.001, first_s = 1.2, span_s = 10;  // at constant velocity

/// Amplitude at a frequency, after subtracting a straight line through the ends of the section: the stage
/// moves while it vibrates.
Complex projected(std::span<const double> values, double frequency_hz) {
  const size_t first = whole_count(first_s / sample_time_s), count = whole_count(span_s / sample_time_s);
  const double slope = (values[first + count] - values[first]) / double(count);
  Complex sum = 0;
  for (size_t k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * frequency_hz * sample_time_s * double(k);
    sum +=
        (values[first + k] - values[first] - slope * double(k)) * Complex(std::cos(angle), -std::sin(angle));
  }
  return sum * (2 / double(count));
}

}  // namespace

FrequencyResponse measured_response(const Recording& recording, int lowest_hz, int highest_hz) {
  const auto command = column(recording, "command.sum"), position = column(recording, "stage.position");
  FrequencyResponse result;
  for (int hz = lowest_hz; hz <= highest_hz; ++hz) {
    const double half_angle = std::numbers::pi * hz * sample_time_s;
    const Complex held = std::polar(std::sin(half_angle) / half_angle, -half_angle);
    result.frequency_hz.push_back(hz);
    result.response.push_back(projected(position, hz) / (projected(command, hz) * held));
  }
  return result;
}

FrequencyResponse nominal_response(const std::vector<double>& frequency_hz) {
  constexpr double mass = 0.2621, damping = 3;  // V s²/m, V s/m
  FrequencyResponse result{frequency_hz, {}};
  for (const double hz : frequency_hz) {
    const Complex s(0, 2 * std::numbers::pi * hz);
    result.response.push_back(1.0 / (s * (mass * s + damping)));
  }
  return result;
}

}  // namespace loopwright::paper
