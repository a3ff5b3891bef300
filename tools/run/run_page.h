/// Presents a run: verdict, scopes of its signals, the diagram, parameters, solver statistics, warnings.
#pragma once
#include "engine/run/simulation.h"
#include "tools/report/report.h"
#include "tools/run/scopes.h"
#include "tools/run/verdict.h"

namespace loopwright {

/// `plan` is compiled from `diagram`, which is drawn unless it is null. `beside`: other recordings, laid over
/// the run.
report::Page run_page(const Diagram* diagram, const Plan& plan, const RunResult& result,
                      const RunFigures& figures, const std::vector<NamedRecording>& beside = {});

/// Recordings laid over each other, the first being what the others differ from.
report::Page recordings_page(const std::vector<NamedRecording>& recordings);

/// A few lines for a terminal: how it ended, statistics, figures, range and last value of every logged
/// signal.
std::string run_summary(const Plan& plan, const RunResult& result, const RunFigures& figures);

}  // namespace loopwright
