/// Presents a run: the diagram's picture, scopes of its signals, parameters, solver statistics, warnings.
#pragma once
#include "engine/run/simulation.h"
#include "tools/report/graph_picture.h"
#include "tools/report/report.h"

namespace loopwright {

/// The plan's blocks and wires, for drawing.
report::Graph graph_of(const Plan& plan);

report::Page run_page(const Plan& plan, const RunResult& result);

/// A few lines for a terminal: how it ended, statistics, range and last value of every logged signal.
std::string run_summary(const Plan& plan, const RunResult& result);

}  // namespace loopwright
