/// The stage between command and measured position, as frequencies see it.
#pragma once
#include <complex>
#include <vector>
#include "engine/record/recording.h"

namespace loopwright::paper {

struct FrequencyResponse {
  std::vector<double> frequency_hz;
  std::vector<std::complex<double>> response;  ///< m/V
};

/// Position over command of a recording of diagrams/linear_motor/frequency_response.json, at the whole
/// frequencies within the limits: both signals are projected on each over ten whole seconds. The command is
/// held from sample to sample; its share, e^(-jωT/2) sin(ωT/2)/(ωT/2), is divided out. Below some 5 Hz
/// cogging holds the stage like a spring, and there is no response of the mass to be seen.
FrequencyResponse measured_response(const Recording& recording, int lowest_hz = 5, int highest_hz = 200);

/// 1/(M s² + B s) with the nominal mass and damping of the controller.
FrequencyResponse nominal_response(const std::vector<double>& frequency_hz);

}  // namespace loopwright::paper
