/// Long calls from Python: other Python threads go on meanwhile, and Ctrl-C ends the call.
#pragma once
#include <pybind11/pybind11.h>
#include <atomic>
#include <chrono>
#include <future>
#include <type_traits>

namespace loopwright::python {

/// The period at which a call looks for Ctrl-C.
constexpr std::chrono::milliseconds signal_period{50};

/// Calls `work(interrupt)` on a thread of its own without the interpreter's lock. The calling thread looks
/// for signals, because Python handles them in its main thread only, and sets `interrupt` when a handler
/// raises. The exception of the handler, or that of the work, is thrown after the work has ended.
template <class Work>
auto interruptible(Work&& work) -> std::invoke_result_t<Work, const std::atomic<bool>&> {
  std::atomic<bool> interrupt{false};
  auto result = [&] {
    const pybind11::gil_scoped_release release;
    return std::async(std::launch::async, [&] { return work(std::as_const(interrupt)); });
  }();
  const auto ended = [&] {
    const pybind11::gil_scoped_release release;
    return result.wait_for(signal_period) == std::future_status::ready;
  };
  bool was_signalled = false;
  pybind11::object type, value, trace;
  while (!ended()) {
    if (was_signalled || PyErr_CheckSignals() == 0) continue;
    was_signalled = true;
    interrupt = true;
    PyErr_Fetch(&type.ptr(), &value.ptr(), &trace.ptr());
  }
  if (!was_signalled) return result.get();
  try {
    result.get();
  } catch (const std::exception&) {
    // The interruption is what the user asked for; a failure on the way out says nothing more.
  }
  PyErr_Restore(type.release().ptr(), value.release().ptr(), trace.release().ptr());
  throw pybind11::error_already_set();
}

/// A function of Python as a callback `progress(done, total)` of a long call. What it raises is reported as
/// unraisable: a mistake in a progress bar does not end a run.
inline auto progress_to(const pybind11::function& function) {
  return [&function](double done, double total) {
    const pybind11::gil_scoped_acquire acquire;
    try {
      function(done, total);
    } catch (pybind11::error_already_set& error) {
      error.restore();
      PyErr_WriteUnraisable(function.ptr());
    }
  };
}

}  // namespace loopwright::python
