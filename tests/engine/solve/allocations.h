// Counts every malloc of this program, libraries included.
#pragma once
#include <cstdint>

namespace loopwright::testing {

/// False under a sanitizer, which brings an allocator of its own.
bool allocations_are_counted();
int64_t allocations();

}  // namespace loopwright::testing
