/// Filters without phase shift: forward and backward over a whole record.
#pragma once
#include <span>
#include <vector>

namespace loopwright {

/// Butterworth low-pass of fourth order, run forward and backward (eighth order in amplitude, zero phase).
/// The ends are continued by reflection at the end points. `cutoff` in Hz, below half the sample rate; at or
/// above 0.45 of the rate the values are returned unchanged.
std::vector<double> zero_phase_low_pass(std::span<const double> values, double cutoff, double sample_time);

}  // namespace loopwright
