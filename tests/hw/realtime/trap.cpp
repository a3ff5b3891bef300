#include "tests/hw/realtime/trap.h"
#include <dlfcn.h>
#include <pthread.h>
#include <atomic>
#include <cstddef>

namespace {
thread_local bool is_watched = false;
std::atomic<int64_t> allocations = 0, exceptions = 0, locks = 0;

template <class Function> Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}
}  // namespace

#if !defined(__SANITIZE_ADDRESS__)
// The entry points of the GNU C library, so that its allocator can be observed from outside.
extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* malloc(size_t size) { return allocations += is_watched, __libc_malloc(size); }
void* calloc(size_t number, size_t size) { return allocations += is_watched, __libc_calloc(number, size); }
void* realloc(void* old, size_t size) { return allocations += is_watched, __libc_realloc(old, size); }
}
#endif

extern "C" {
int pthread_mutex_lock(pthread_mutex_t* mutex) {
  static auto* const lock = next<int(pthread_mutex_t*)>("pthread_mutex_lock");
  locks += is_watched;
  return lock(mutex);
}
[[noreturn]] void __cxa_throw(void* object, void* type, void (*destroy)(void*)) {
  using Throw = void(void*, void*, void (*)(void*));
  static auto* const raise = next<Throw>("__cxa_throw");
  exceptions += is_watched;
  raise(object, type, destroy);
  __builtin_unreachable();
}
}

namespace loopwright::hw {

bool can_trap() {
#if defined(__SANITIZE_ADDRESS__)
  return false;
#else
  return true;
#endif
}
void begin_trap() { is_watched = true; }
void end_trap() { is_watched = false; }
Trapped take_trapped() { return {allocations.exchange(0), exceptions.exchange(0), locks.exchange(0)}; }

}  // namespace loopwright::hw
