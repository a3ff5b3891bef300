/// Frequency response of the stage between command and measured position.
#pragma once
#include <complex>
#include <vector>
#include "engine/record/recording.h"

namespace loopwright::paper {

struct FrequencyResponse {
  std::vector<double> frequency_hz;
  std::vector<std::complex<double>> response;  ///< m/V
};

/// Position over command of a recording of diagrams/linear_motor/frequency_response.json, at the integer
/// frequencies within the limits: both signals are projected on each frequency over ten whole seconds. The
/// command is held from sample to sample; its factor, e^(-jωT/2) sin(ωT/2)/(ωT/2), is divided out. Below
/// about 5 Hz cogging holds the stage like a spring, and the response of the mass is not visible.
FrequencyResponse measured_response(const Recording& recording, int lowest_hz = 5, int highest_hz = 200);

/// 1/(M s² + B s) with the nominal mass and damping of the controller.
FrequencyResponse nominal_response(const std::vector<double>& frequency_hz);

}  // namespace loopwright::paper
