/// Sentences on why a loop ended by a rule of the device file's policy.
#pragma once
#include "hw/realtime/control_loop.h"

namespace loopwright::hw {

/// Empty for other ends. `at`: "at t = 0.5 s".
std::string policy_that_ended(LoopEnd::Why why, const LoopStatistics& statistics, const Policy& policy,
                              const std::string& at);

}  // namespace loopwright::hw
