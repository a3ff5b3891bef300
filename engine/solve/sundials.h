/// Owners for the objects of SUNDIALS, each released by its own function.
#pragma once
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace loopwright::sundials {

/// Calls the matching function of SUNDIALS when an owner is destroyed.
struct Release {
  void operator()(SUNContext context) const { SUNContext_Free(&context); }
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
  void operator()(SUNMatrix matrix) const { SUNMatDestroy(matrix); }
  void operator()(SUNLinearSolver solver) const { SUNLinSolFree(solver); }
  void operator()(SUNNonlinearSolver solver) const { SUNNonlinSolFree(solver); }
};
template <class Handle> using Owner = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

/// Takes ownership of a new handle; SUNDIALS returns null only if memory is exhausted.
template <class Handle> Owner<Handle> own(Handle handle) {
  if (handle == nullptr) throw std::bad_alloc();
  return Owner<Handle>(handle);
}

/// In place of the handler that prints errors: callers look at the flags.
inline void print_nothing(int, const char*, const char*, char*, void*) {}

/// `flag` is what a set-up function returned, 0 after success. Throws std::runtime_error otherwise.
inline void require(int flag, const char* call) {
  if (flag != 0) throw std::runtime_error(std::string("SUNDIALS refused ") + call);
}

inline Owner<SUNContext> make_context() {
  SUNContext context = nullptr;
  SUNContext_Create(nullptr, &context);
  return own(context);
}

}  // namespace loopwright::sundials
