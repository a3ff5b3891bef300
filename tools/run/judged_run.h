/// A run together with what it shows: the one way in which the command, the studio and Python run a diagram.
#pragma once
#include "engine/run/simulation.h"
#include "tools/run/verdict.h"

namespace loopwright {

struct JudgedRun {
  RunResult result;
  RunFigures figures;
};

/// Runs the plan and judges how signals follow their references, and how long limits hold. A null diagram:
/// what is to follow what is guessed. Throws InputError, and before the run: a mistake in "figures" costs no
/// time. A checkpoint has the columns of the log and no others: limits are not watched in runs with them.
JudgedRun run_and_judge(const Diagram* diagram, const Plan& plan, const RunOptions& options = {});

}  // namespace loopwright
