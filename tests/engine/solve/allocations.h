// Counts every malloc of this program, including libraries.
#pragma once
#include <cstdint>

namespace loopwright::testing {

/// False under a sanitizer, which has its own allocator.
bool allocations_are_counted();
int64_t allocations();

}  // namespace loopwright::testing
