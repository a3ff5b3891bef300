/// Counts operations that must not occur in a real-time thread: allocations, exceptions, locks.
#pragma once
#include <cstdint>

namespace loopwright::hw {

/// False under a sanitizer, which has its own allocator.
bool can_trap();
/// From here on the calling thread is observed.
void begin_trap();
void end_trap();

struct Trapped {
  int64_t allocations, exceptions, locks;
};
/// In all observed threads since the last call.
Trapped take_trapped();

}  // namespace loopwright::hw
