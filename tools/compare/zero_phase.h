/// Filters that shift nothing: forward and backward over a whole record.
#pragma once
#include <span>
#include <vector>

namespace loopwright {

/// Butterworth low-pass of fourth order, run forward and backward (eighth order in amplitude, no phase).
/// The ends are continued by reflection at the end points. `cutoff` in Hz below half the sample rate; at or
/// above 0.45 of the rate the values are returned as they are.
std::vector<double> zero_phase_low_pass(std::span<const double> values, double cutoff, double sample_time);

}  // namespace loopwright
