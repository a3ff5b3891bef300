/// The sampled common job written by hand for SIMD without an engine: loops over registers, all values of a
/// register in local variables, the reference tabulated once for all runs. It is the reference for the speed
/// of the engine's lanes.
#pragma once
#include <span>
#include "tests/benchmarks/common_job_by_hand.h"

namespace loopwright::by_hand {

/// At the samples 0, 1, … of the job.
std::vector<Wanted> tabulated_reference(const Job& job);

/// As run_rk4 for 32 masses [kg] at once, the number of the engine's lanes. The machine must have the
/// instructions.
void run_lanes_avx2(const Job& job, std::span<const Wanted> reference, int steps_per_sample,
                    std::span<const double, 32> masses, Outcome* outcomes);
void run_lanes_avx512(const Job& job, std::span<const Wanted> reference, int steps_per_sample,
                      std::span<const double, 32> masses, Outcome* outcomes);

}  // namespace loopwright::by_hand
