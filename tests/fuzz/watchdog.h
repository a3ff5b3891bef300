/// Names the mutant when a test crashes or hangs, so that the failure can be reproduced.
#pragma once
#include <string>

namespace loopwright::fuzz {

/// From now on the process works on this mutant. If it crashes, or works longer than 20 s of processor time
/// (or waits longer than 10 min), seed and text go to stderr and the process aborts. `text` must be valid
/// until the next call.
void watch(unsigned long long seed, const std::string& text);

/// Ends the watch.
void unwatch();

}  // namespace loopwright::fuzz
