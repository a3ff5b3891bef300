#include "tests/benchmarks/common_job_lanes_by_hand_of.h"

namespace loopwright::by_hand {

void run_lanes_avx2(const Job& job, std::span<const Wanted> reference, int steps_per_sample,
                    std::span<const double, 32> masses, Outcome* outcomes) {
  run_lanes<Lanes<4, 8>>(job, reference, steps_per_sample, masses.data(), outcomes);
}

}  // namespace loopwright::by_hand
