#include "tests/engine/solve/allocations.h"

#include <cstddef>

#if defined(__SANITIZE_ADDRESS__)

namespace loopwright::testing {
bool allocations_are_counted() { return false; }
int64_t allocations() { return 0; }
}  // namespace loopwright::testing

#else

namespace {
int64_t count = 0;  // the tests run in one thread
}

// The entry points of the GNU C library, so that its allocator can be counted from outside.
extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);

void* malloc(size_t size) { return ++count, __libc_malloc(size); }
void* calloc(size_t number, size_t size) { return ++count, __libc_calloc(number, size); }
void* realloc(void* old, size_t size) { return ++count, __libc_realloc(old, size); }
}

namespace loopwright::testing {
bool allocations_are_counted() { return true; }
int64_t allocations() { return count; }
}  // namespace loopwright::testing

#endif
