/// A diagram as a graph for its drawing: structure from the diagram, units and rates of wires from its plan.
#pragma once
#include "engine/diagram/diagram.h"
#include "engine/plan/plan.h"
#include "tools/report/graph.h"

namespace loopwright {

/// `plan` is compiled from `diagram`. Subdiagrams are nodes with ports, and their blocks stand inside.
/// A diagram of more than `most_nodes` blocks is drawn down to the depth at which it has fewer.
report::Graph diagram_graph(const Diagram& diagram, const Plan& plan, size_t most_nodes = 2000);

}  // namespace loopwright
