/// Runs inside a longer computation, which can only go on with a finished run.
#pragma once
#include <stdexcept>
#include "engine/run/simulation.h"

namespace loopwright {

/// The user requested the end. Nothing is wrong with the diagram: the program answers with an exit code of
/// its own.
struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws Interrupted for a run that was interrupted, std::runtime_error for one that failed.
inline void require_finished(const RunResult& result) {
  if (result.status == RunStatus::interrupted) throw Interrupted(result.message);
  if (result.status != RunStatus::finished) throw std::runtime_error(result.message);
}

}  // namespace loopwright
