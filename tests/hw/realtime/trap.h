/// Counts what must not happen in a real-time thread: allocations, exceptions, locks.
#pragma once
#include <cstdint>

namespace loopwright::hw {

/// False under a sanitizer, which brings an allocator of its own.
bool can_trap();
/// From here on the calling thread is watched.
void begin_trap();
void end_trap();

struct Trapped {
  int64_t allocations, exceptions, locks;
};
/// In all watched threads since the last call.
Trapped take_trapped();

}  // namespace loopwright::hw
