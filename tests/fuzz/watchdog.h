/// Names the mutant when a test crashes or hangs: without the mutant there is nothing to repair.
#pragma once
#include <string>

namespace loopwright::fuzz {

/// From now on the process works on this mutant. When it crashes, or works longer than 20 s of processor time
/// (or waits longer than 10 min), seed and text go to stderr and the process aborts. `text` must live until
/// the next call.
void watch(unsigned long long seed, const std::string& text);

/// Nothing to watch any more.
void unwatch();

}  // namespace loopwright::fuzz
